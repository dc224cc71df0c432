(* The checkers as a program of OCaml.  TRUSTED, by those who use that program: read this file.

   Compiled in a folder, it writes checker.ml there, which is that of proofs/kernel/ocaml (a test compares them;
   `make generated` writes it again).  Only truth values, lists, pairs, options and characters become those of OCaml;
   numbers stay Coq's own.
   `accepted_at`, `settled`, `known` and `shown` say that `accepts_proof`, `settles_fact`, `is_known_fact` and
   `accepts_drive` are right; `holds_of_motions` and `holds_by_induction`, that `adds_instances` is; `no_solution`,
   that `refutes_program` is. *)
From Coq Require Import Extraction ExtrOcamlBasic ExtrOcamlString ZArith QArith.
From Roadproof Require Values Products Known Shown Schemas Refuted.

Definition accepts_proof := Values.accepts_at.
Definition settles_fact := Products.settles.
Definition is_known_fact := Known.is_known.
Definition accepts_drive := Shown.accepts.
Definition adds_instances := Schemas.adds.
Definition refutes_program := Refuted.checks.
Definition are_inductions := List.forallb Schemas.is_induction.

Extraction Language OCaml.
Extraction "checker.ml" accepts_proof settles_fact is_known_fact accepts_drive adds_instances are_inductions
  refutes_program Z.add Z.mul Z.opp
  Products.c_ Products.x_ Products.given_ Products.number_ Products.square_ Products.times_.
