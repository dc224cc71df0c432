(* The meaning is not empty.  NOT TRUSTED, and not used: for a reader who wonders.

   There is a world, so that not everything is valid; until reads its left side inside its interval only; and
   quantifiers that are written with functions range over their domains. *)
From Coq Require Import Reals QArith Qreals String List Lra.
From Roadproof Require Import Meaning.
Import ListNotations.
Open Scope R_scope.
Open Scope string_scope.

Definition some_world : world.
Proof.
  refine {| element := bool; somewhere := true; parameter := fun _ => 1; variable := fun _ => 0;
            value := fun _ _ t => t; measure := fun _ _ => 1; measure_positive := _; occupies := fun _ _ _ => True;
            adjacent := fun l m => l <> m; adjacent_irreflexive := _; adjacent_symmetric := _;
            lanelets := fun l m => l = m; lanelets_reflexive := _; zone_of := fun _ => main |}.
  - intros; lra.
  - intros l H; apply H; reflexivity.
  - intros l m H E; apply H; symmetry; exact E.
  - reflexivity.
Defined.
Lemma not_everything : ~ valid [] (Truth false).
Proof.
  intros H. assert (E : false = true); [|discriminate].
  apply (H some_world (fun _ => true)).
  constructor.
Qed.

(* Until, as roadproof reads it: false U[1, 2] true holds, though false does not hold before 1. *)
Lemma until_reads_inside : valid [] (Until (Truth false) (Num 1) (Some (Num 2)) (Truth true)).
Proof.
  intros W named _. exists (0 + Q2R 1). unfold within. cbn [number holds].
  assert (A : Q2R 1 = 1) by (unfold Q2R; simpl; lra). assert (B : Q2R 2 = 2) by (unfold Q2R; simpl; lra).
  rewrite A, B. split; [split; lra|split; [reflexivity|intros w H; exfalso; lra]].
Qed.

(* Intervals are closed, and touching counts: F[1, 1] p is p a second later. *)
Lemma intervals_are_closed W named b t p :
  holds W named b t (Eventually (Num 1) (Some (Num 1)) p) <-> holds W named b (t + 1) p.
Proof.
  assert (A : Q2R 1 = 1) by (unfold Q2R; simpl; lra).
  cbn [holds]. unfold within. cbn [number]. rewrite A. split.
  - intros [u [H P]]. replace (t + 1) with u by lra. exact P.
  - intros P. exists (t + 1). split; [lra|exact P].
Qed.

(* One inside another, of which each speaks of the other's element. *)
Lemma quantifiers_nest W named b t (a : vehicle) :
  holds W named b t (some_in Lanes (fun l => every_in (Adjacent l) (fun m => Or (Occupies a l) (Occupies a m))))
  <-> exists l, forall m, adjacent W l m -> occupies W a l t \/ occupies W a m t.
Proof.
  cbn. split.
  - intros [l [_ H]]. exists l. exact H.
  - intros [l H]. exists l. split; [exact I|exact H].
Qed.
