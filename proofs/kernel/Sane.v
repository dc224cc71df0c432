(* The meaning is not empty.  NOT TRUSTED, and not used: for a reader who wonders.

   There is a world, so that not everything is valid; until reads its left side inside its interval only; and
   quantifiers that are written with functions range over their domains.  There is a motion, and not every world is one;
   drivers of Prescribed.v have a motion from every state, some collide and some do not; and a program has a solution. *)
From Coq Require Import Reals QArith Qreals String List Lra.
From Roadproof Require Import Meaning Drive Motion Moves Integral Prescribed Braking Boundary.
From Roadproof Require Programs.
Import ListNotations.
Open Scope R_scope.
Open Scope string_scope.

Definition some_world : world.
Proof.
  refine {| element := bool; somewhere := true; parameter := fun _ => 1; variable := fun _ => 0;
            value := fun _ _ t => t; measure := fun _ _ => 1; measure_positive := _;
    shape := fun _ => {| s_from := None; s_to := None; d_from := 0; d_to := 1 |};
            adjacent := fun l m => l <> m; adjacent_irreflexive := _; adjacent_symmetric := _;
            lanelets := fun l m => l = m; lanelets_reflexive := _; zone_of := fun _ => main |}.
  - intros; lra.
  - intros l H; apply H; reflexivity.
  - intros l m H E; apply H; symmetry; exact E.
  - reflexivity.
Defined.
(* Bounds of parameters have a world.  Those of a signal may contradict each other here; the language rejects such. *)
Definition of_parameter (b : bound) : Prop := match b with at_least_0 _ | above_0 _ => True | _ => False end.
Lemma not_everything bounds : Forall of_parameter bounds -> ~ valid bounds (Truth false).
Proof.
  intros P H. assert (E : false = true); [|discriminate].
  apply (H some_world (fun _ => true)).
  refine (Forall_impl _ _ P). intros [p|p| |] []; simpl; lra.
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

(* --- motions -------------------------------------------------------------------------------------------- *)
(* A car goes at 10 m/s; its braking grows for 2 s to 4 m/s2, and jumps to 1 m/s2. *)
Definition some_drive : drive := {|
  bodies := [("SV", {| is_a := car; long := 4; wide := 2; long_above_0 := eq_refl; wide_above_0 := eq_refl;
    along := {| starts_at := 0; starts_with := 10; pieces := [(2, 0, -2)]%Q; finally := -1 |}; across := still |})];
  first_rectangle := {| lane := "L"; lies_in := main; from_s := None; to_s := Some 50%Q; right_d := -3; left_d := 1 |};
  other_rectangles := []; Drive.beside := []; lanes_named := []; values := []; signals := []; numbers := [];
  repeats := None |}.
Lemma some_motion : motion (world_of some_drive).
Proof. apply drives_move; repeat constructor; cbn; unfold Q2R; simpl; lra. Qed.
Lemma not_everything_of_motions : ~ valid_of_motions [] (Truth false).
Proof.
  intros H. assert (E : false = true); [|discriminate].
  exact (H (world_of some_drive) (element_named some_drive) some_motion (Forall_nil _)).
Qed.
(* Places t and speeds t are no motion: in half a second it would go half a metre at 0.5 m/s or less. *)
Lemma not_every_world_moves : ~ motion some_world.
Proof.
  intros M. pose proof (Motion.grows some_world M Place_lon Speed_lon "SV" eq_refl) as G.
  pose proof (grows_at_most _ _ (/ 2) 0 (/ 2) G ltac:(lra)) as N. cbn [value some_world] in N.
  assert (/ 2 - 0 <= / 2 * (/ 2 - 0)); [apply N; intros u U; lra|lra].
Qed.

(* --- drivers -------------------------------------------------------------------------------------------- *)
(* The careful driver has a motion from every state and in every reading: no collision is ruled out because there is
   none.  So have the others (`brakes_exists`, `assisted_exists`, `responds_exists`). *)
Section Drivers.
  Variables (W : world) (now : R) (a b : vehicle).
  Notation par := (parameter W).
  Hypotheses (Ha : 0 <= speed W now a) (Hg : 0 <= gap W now a b).
  Hypotheses (H_ramp : 0 < par "cc_ramp") (H_braking : 0 < par "cc_braking") (H_delay : 0 <= par "cc_delay")
    (H_ttc : 0 <= par "cc_ttc").
  Lemma gate_is_found s : 0 <= s -> exists o, first (close W now a b) s o.
  Proof.
    intros S. destruct (Rtotal_order (speed W now b) (speed W now a)) as [V|V].
    - eexists. apply opens; [exact V|reflexivity].
    - destruct (Rle_lt_dec (gap W now a b) 0) as [G|G]; [destruct V as [V|V]|].
      + exists (Some s). repeat split; [lra| |intros; lra]. unfold close. rewrite V. nra.
      + destruct (Rle_lt_dec (s + par "cc_ttc") 0) as [Z|Z].
        * exists (Some s). repeat split; [lra| |intros; lra]. unfold close, Prescribed.par. nra.
        * exists None. intros t T C. unfold close, Prescribed.par in C.
          assert (0 < (speed W now b - speed W now a) * (t + par "cc_ttc")) by (apply Rmult_lt_0_compat; lra). lra.
      + exists None. intros t T C. unfold close, Prescribed.par in C.
        assert (0 <= (speed W now b - speed W now a) * (t + par "cc_ttc")) by (apply Rmult_le_pos; lra). lra.
  Qed.
  Lemma some_careful_motion p k y w : known W p -> 0 <= y -> 0 < w -> exists x, careful W now p k a b y w x.
  Proof.
    intros K Y P. pose proof (evaluation_positive W p K) as E. pose proof (seen_positive W p y K Y) as S.
    pose proof (over_positive _ _ S P) as S'.
    assert (E' : 0 <= evaluation W p * w) by (apply Rmult_le_pos; lra).
    assert (L : forall d s o, 0 <= d -> 0 <= s -> first (close W now a b) s o ->
      match later d o with Some q => 0 <= q | None => True end).
    { intros d s [t|] D T F; [|exact I]. destruct F as [F _]. cbn. lra. }
    assert (O : exists o, onset W now p k a b y w o /\ match o with Some q => 0 <= q | None => True end).
    { destruct k.
      - eexists. split; [apply onset_ungated; auto|cbn; lra].
      - destruct (gate_is_found _ S') as [o G]. exists (later (evaluation W p + par "cc_delay") o).
        split; [apply onset_before_perception; auto; exists o; auto|exact (L (evaluation W p + par "cc_delay") _ o ltac:(lra) S' G)].
      - assert (Q : 0 <= (seen W p y + evaluation W p * w) / w) by (apply over_positive; lra).
        destruct (gate_is_found _ Q) as [o G]. exists (later (par "cc_delay") o).
        split; [apply onset_before_delay; auto; exists o; auto|exact (L (par "cc_delay") _ o H_delay Q G)]. }
    destruct O as [[q|] [O Q]].
    - destruct (brakes_exists (speed W now a) q (par "cc_ramp") (par "cc_braking")) as [x X]; try lra.
      exists x, (Some q). split; assumption.
    - destruct (constant_exists (speed W now a) Ha) as [x X]. exists x, None. split; assumption.
  Qed.
End Drivers.

(* POV comes in 10 m ahead at v.  SV goes at 10 m/s and reacts after 2 s: it hits a POV that stands, and no faster one. *)
Definition ahead_at (v : R) : world.
Proof.
  refine {| element := unit; somewhere := tt; parameter := fun _ => 1; variable := fun _ => 0;
            value := fun n x _ => let pov := String.eqb x "POV" in
              match n with
              | Place_lon => if pov then 11 else 0
              | Place_lat => if pov then 1 else 0
              | Speed_lon => if pov then v else 10
              | Speed_lat => if pov then -1 else 0
              | _ => 0
              end;
            measure := fun _ _ => 1; measure_positive := _; shape := fun _ => {| s_from := None; s_to := None; d_from := 0; d_to := 1 |};
            adjacent := fun _ _ => False; adjacent_irreflexive := _; adjacent_symmetric := _;
            lanelets := fun _ _ => True; lanelets_reflexive := _; zone_of := fun _ => main |}; intros; try lra; tauto.
Defined.
Ltac by_boundary := rewrite <- r157_boundary by (cbn; lra); unfold from_both, from_side, intrusion_hits, Gained.hits,
  Gained.hasEverGained, Gained.hasGained, Gained.stillFaster, Gained.gains, Prescribed.beside, gap, lengths; cbn.
Lemma some_collision : cut_in (ahead_at 0) 0 (r157 (ahead_at 0) 0 "SV") "SV" "POV".
Proof. by_boundary. left. repeat split; lra. Qed.
Lemma not_every_collision : ~ cut_in (ahead_at 20) 0 (r157 (ahead_at 20) 0 "SV") "SV" "POV".
Proof. by_boundary. lra. Qed.

(* --- programs ------------------------------------------------------------------------------------------- *)
(* x between 0 and 2 is more than 1. *)
Lemma some_solution : exists x, Programs.solves x {|
  Programs.scale := 1; Programs.columns := [Programs.a_column 1 0 2]; Programs.products := []; Programs.equal := [];
  Programs.above := []; Programs.nodes := [Programs.a_leaf 1 true [Programs.a_term 1 1] (-1)]; Programs.condition := 1 |}.
Proof.
  exists (fun _ => 2). repeat split; cbn; intros; try tauto.
  - destruct H as [H|[]]. injection H as <- <- <-. lra.
  - destruct H as [H|[]]. injection H as <- <- <-. lra.
  - eapply Programs.by_value; [left; reflexivity|]. unfold Programs.worth. simpl. lra.
Qed.
