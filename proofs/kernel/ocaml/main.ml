(* Reads forms (reader.ml) from standard input and says of each, in a line: NAME accepted, NAME refused,
   NAME lemma K (the K-th fact about one instant is not proved) or NAME unread.  TRUSTED. *)
open Checker
open Reader
open Certificates

type verdict = Accepted | Refused | Lemma of int

let holds bounds f = function
  | [ Word "known" ] -> is_known_fact bounds f
  | [ terms; r ] -> settles_fact bounds (list term terms) f (reason r)
  | _ -> unread "a lemma"

(* The first lemma that its reason does not show; the formulas of all where there is none. *)
let rec settle bounds known k shown = function
  | [] -> Ok (List.rev shown)
  | Node (f :: why) :: rest ->
      let f = formula known f in
      if holds bounds f why then settle bounds known (k + 1) (f :: shown) rest else Error k
  | _ -> unread "a lemma"

let ruled accepted = if accepted then Accepted else Refused

(* Whether lemmas and a tableau show that a claim is valid. *)
let proves bounds known claim = function
  | [ List lemmas; parameters; values; tableau ] -> (
      match settle bounds known 1 [] lemmas with
      | Error k -> Lemma k
      | Ok facts ->
          let values = list (pair name q) values in
          ruled (accepts_proof (list name parameters) bounds facts values claim (tree tableau)))
  | _ -> unread "a proof"

let refuted = function
  | Node [ scale; columns; products; equal; above; nodes; condition; tree ] ->
      let question = program scale columns products equal above nodes condition in
      refutes_program question (refutation tree)
  | _ -> unread "a program"

(* proof: the claim is valid.  traces: so it is where instances of inductions are put before it, which makes the
   formula that is supposed; motions: where instances of all schemas are, and the claim holds of motions.  drive: it is true of a drive or trace.
   none_within: no program has a solution. *)
let judge = function
  | Word "proof" :: _ :: _ :: bounds :: given :: claim :: why ->
      let known = definitions given in
      proves (list bound bounds) known (formula known claim) why
  | Word (("traces" | "motions") as what) :: _ :: _ :: bounds :: given :: claim :: schemas :: supposed :: why ->
      let bounds = list bound bounds and known = definitions given in
      let schemas = list (schema known) schemas and supposed = formula known supposed in
      if (what = "motions" || are_inductions schemas) && adds_instances bounds schemas supposed (formula known claim)
      then proves bounds known supposed why
      else Refused
  | [ Word "drive"; _; _; bounds; given; claim; what; why ] ->
      let claim = formula (definitions given) claim in
      ruled (accepts_drive (drive what) (list bound bounds) claim (derivation why))
  | [ Word "none_within"; _; _; programs ] -> ruled (List.for_all Fun.id (list refuted programs))
  | _ -> unread "a form"

let said form =
  match judge form with
  | Accepted -> "accepted"
  | Refused -> "refused"
  | Lemma k -> "lemma " ^ string_of_int k
  | exception Unread what -> "unread: this is not " ^ what

let standard_input () =
  let found = Buffer.create 65536 in
  let rec more () = Buffer.add_channel found stdin 1; more () in
  try more () with End_of_file -> Buffer.contents found

let () =
  match forms (standard_input ()) with
  | exception Unread what -> prerr_endline ("this is not " ^ what); exit 2
  | found ->
      List.iter
        (function
          | Node (_ :: Word x :: _ as form) -> print_endline (x ^ " " ^ said form)
          | _ -> prerr_endline "this is not a form"; exit 2)
        found
