(* Named facts.  NOT TRUSTED: tactics, whose proofs Coq checks.

   What is found neither by products (Products.v) nor by `instant` of the terms that the library speaks of: the
   longitudinal RSS guarantee (P9, from Rss.v).  `some_instant` tries all that there is. *)
From Coq Require Import Reals QArith Qreals String List Lra Psatz Classical.
From Roadproof Require Import Meaning Rss Instant.
Import ListNotations.
Open Scope R_scope.

Lemma minus_as_written x y : x - y = x + -1 * y.
Proof. ring. Qed.
Ltac guarantee := open_fact; cbn [less at_most];
  match goal with |- context [parameter ?W "b_min"%string <= parameter ?W "b_max"%string] =>
    pose proof (envelopes (parameter W "a_max"%string) (parameter W "b_max"%string) (parameter W "b_min"%string) (parameter W "rho"%string)
      ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)) as G;
    specialize (fun H => G H (variable W "v_r"%string) (variable W "v_f"%string) (variable W "gap"%string) (variable W "t"%string));
    unfold dRSS, front, rear, braking in G;
    rewrite !minus_as_written in G;
    tauto
  end.

Ltac some_instant := first
  [ solve [instant_linear] | solve [guarantee] | solve [instant] ].
