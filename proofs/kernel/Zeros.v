(* Where polynomials are 0.  NOT TRUSTED: proved.

   A polynomial that is above 0 at a, and not at b, has a first instant after a at which it is 0; and one that is not
   above 0 before an instant is not above 0 at it.  Such an instant may be irrational, so no derivation names it. *)
From Coq Require Import Reals QArith Qreals List Lra.
From Roadproof Require Import Signs.
Import ListNotations.
Open Scope R_scope.

Lemma eval_continuous p : continuity (eval p).
Proof.
  induction p as [|x p IH]; cbn [eval].
  - apply continuity_const. intros y z. reflexivity.
  - apply (continuity_plus (fun _ => Q2R x) (fun t => t * eval p t)).
    + apply continuity_const. intros y z. reflexivity.
    + apply (continuity_mult id (eval p)); [apply derivable_continuous, derivable_id|exact IH].
Qed.

(* What is above 0 at an instant is so near it, and likewise below 0. *)
Lemma near p x : eval p x <> 0 -> exists d, 0 < d /\ forall y, x - d < y < x + d -> 0 < eval p x * eval p y.
Proof.
  intros N. destruct (eval_continuous p x (Rabs (eval p x))) as [d [D H]]; [apply Rabs_pos_lt, N|].
  exists d. split; [exact D|]. intros y Y. destruct (Req_dec x y) as [<-|E]; [nra|].
  specialize (H y). simpl in H. unfold R_dist in H.
  assert (A : Rabs (eval p y - eval p x) < Rabs (eval p x)).
  { apply H. split; [split; [exact Logic.I|exact E]|]. apply Rabs_def1; lra. }
  destruct (Rcase_abs (eval p x)) as [B|B]; [rewrite (Rabs_left _ B) in A|rewrite (Rabs_right _ B) in A];
    apply Rabs_def2 in A; nra.
Qed.

Lemma at_the_end p a u : a < u -> (forall w, a <= w < u -> eval p w <= 0) -> eval p u <= 0.
Proof.
  intros L H. destruct (Rle_lt_dec (eval p u) 0) as [E|E]; [exact E|exfalso].
  destruct (near p u) as [d [D N]]; [lra|]. set (w := Rmax a (u - d / 2)).
  assert (W : a <= w < u) by (unfold w; split; [apply Rmax_l|apply Rmax_lub_lt; lra]).
  assert (V : u - d / 2 <= w) by apply Rmax_r. specialize (H w W). specialize (N w ltac:(lra)). nra.
Qed.

Lemma first_zero p a b : a <= b -> 0 < eval p a -> eval p b <= 0 ->
  exists z, a < z <= b /\ eval p z = 0 /\ forall w, a <= w < z -> 0 < eval p w.
Proof.
  intros L A B. set (E := fun x => a <= x <= b /\ forall y, a <= y <= x -> 0 < eval p y).
  destruct (completeness E) as [z [U S]].
  - exists b. intros x [X _]. lra.
  - exists a. split; [lra|]. intros y Y. replace y with a by lra. exact A.
  - assert (Ea : E a) by (split; [lra|intros y Y; replace y with a by lra; exact A]).
    assert (Za : a <= z) by (apply U, Ea). assert (Zb : z <= b) by (apply S; intros x [X _]; lra).
    assert (P : forall w, a <= w < z -> 0 < eval p w).
    { intros w W. destruct (Rle_lt_dec (eval p w) 0) as [N|N]; [exfalso|exact N].
      assert (z <= w); [|lra]. apply S. intros x [X Y]. destruct (Rle_lt_dec x w) as [G|G]; [exact G|].
      specialize (Y w ltac:(lra)). lra. }
    assert (Z : eval p z = 0).
    { destruct (Req_dec (eval p z) 0) as [G|G]; [exact G|exfalso]. destruct (near p z G) as [d [D N]].
      destruct (Rle_lt_dec (eval p z) 0) as [M|M].
      - assert (a <> z) by (intros ->; lra). set (w := Rmax a (z - d / 2)).
        assert (W : a <= w < z) by (unfold w; split; [apply Rmax_l|apply Rmax_lub_lt; lra]).
        assert (V : z - d / 2 <= w) by apply Rmax_r. specialize (P w W). specialize (N w ltac:(lra)). nra.
      - assert (z <> b) by (intros ->; lra). set (x := Rmin b (z + d / 2)).
        assert (X : z < x <= b) by (unfold x; split; [apply Rmin_glb_lt; lra|apply Rmin_l]).
        assert (V : x <= z + d / 2) by apply Rmin_r. assert (x <= z); [|lra]. apply U. split; [lra|].
        intros y Y. destruct (Rlt_le_dec y z) as [K|K]; [apply P; lra|]. specialize (N y ltac:(lra)). nra. }
    exists z. split; [|split; [exact Z|exact P]]. split; [|exact Zb].
    destruct Za as [K|K]; [exact K|]. rewrite K in A. lra.
Qed.
