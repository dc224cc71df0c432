(* The boundaries of drivers behind a vehicle that brakes, and of RSS.  NOT TRUSTED: proved. *)
From Coq Require Import Reals String List Lra Psatz.
From Roadproof Require Import Meaning Prescribed Braking Gained Boundary Braked.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Section Following.
  Variables (W : world) (now : R) (a b : vehicle).
  Notation par := (parameter W).
  Notation v := (speed W now a).
  Notation w := (speed W now b).
  Notation g := (gap W now a b).
  Notation accelerates := (value W Acceleration_lon b now).
  Hypotheses (Ha : 0 <= v) (Hb : 0 <= w).

  (* where b brakes ahead, and the driver goes so that H is whether it hits b *)
  Definition ahead (H : Prop) : Prop := (accelerates < 0 /\ lies_in_way W now a b /\ 0 <= g) /\ H.
  Lemma ahead_right driver H :
    (0 < braking W now b -> 0 <= g -> (H <-> exists x, driver x /\ exists p, brakes_from w (Some 0) 0 (braking W now b) p
        /\ exists t, 0 <= t /\ x t - p t > g)) ->
    (forall x, driver x -> x 0 = 0) ->
    (ahead H <-> decelerates W now driver a b).
  Proof.
    intros E Z. unfold ahead, decelerates, lies_in_way, in_way, beside, collide.
    assert (B : accelerates < 0 <-> 0 < braking W now b) by (unfold braking; split; lra). rewrite B.
    pose proof (lengths_positive W a b) as L. split.
    - intros [[P [[I1 I2] G]] H']. apply (E P G) in H'. destruct H' as [x [Dx [p [Bp [t T]]]]].
      repeat split; try lra. exists x, p. repeat split; [exact Dx|exact Bp| |exists t; exact T].
      destruct (brakes_right w 0 0 _ (Rle_refl 0) (Rle_refl 0) P p Bp) as [P0 _].
      intros t0 H0. replace t0 with 0 by lra. rewrite (Z x Dx), P0. lra.
    - intros [P [[I1 I2] [G [x [p [Dx [Bp [_ C]]]]]]]]. repeat split; try lra. apply (E P); [lra|].
      exists x. split; [exact Dx|]. exists p. split; [exact Bp|exact C].
  Qed.

  (* --- the competent and careful driver ------------------------------------------------------------------ *)
  Definition notices (only_hard : bool) : Prop := if only_hard then accelerates <= -1 * par "cc_hard" else accelerates < 0.
  Definition following_hits only_hard : Prop :=
    ahead ((notices only_hard
            /\ gainsBraking v w (-1 * accelerates) g (par "cc_evaluation" + par "cc_delay") (par "cc_ramp") (par "cc_braking"))
           \/ (~ notices only_hard /\ 0 < v)).
  Theorem following_boundary only_hard : 0 < par "cc_braking" -> 0 <= par "cc_delay" -> 0 <= par "cc_evaluation" ->
    0 < par "cc_ramp" -> (following_hits only_hard <-> decelerates W now (careful_following W now only_hard a b) a b).
  Proof.
    intros HA Hd He HT. unfold following_hits. apply ahead_right.
    2:{ intros x [[_ B]|[_ B]]; [|destruct B as [taken [_ [_ [_ [X0 _]]]]]; exact X0].
        destruct (brakes_right v (par "cc_evaluation" + par "cc_delay") _ _ ltac:(lra) (Rlt_le _ _ HT) HA x B) as [X0 _]. exact X0. }
    intros P G. set (q := par "cc_evaluation" + par "cc_delay"). assert (Q : 0 <= q) by (unfold q; lra).
    assert (N : notices only_hard <-> noticed W now only_hard b).
    { unfold notices, noticed, braking, Prescribed.par. destruct only_hard; split; intros; lra. }
    rewrite N. replace (-1 * accelerates) with (braking W now b) by (unfold braking; ring).
    destruct (brakes_exists w 0 0 (braking W now b) Hb (Rle_refl 0) (Rle_refl 0) P) as [p Bp].
    destruct (brakes_right w 0 0 _ (Rle_refl 0) (Rle_refl 0) P p Bp) as [P0 Pp].
    assert (E : forall x, brakes_from v (Some q) (par "cc_ramp") (par "cc_braking") x ->
      forall p, brakes_from w (Some 0) 0 (braking W now b) p ->
      ((exists t, 0 <= t /\ x t - p t > g) <-> gainsBraking v w (braking W now b) g q (par "cc_ramp") (par "cc_braking"))).
    { intros x Bx p' Bp'. destruct (brakes_right v q _ _ Q (Rlt_le _ _ HT) HA x Bx) as [X0 X].
      destruct (brakes_right w 0 0 _ (Rle_refl 0) (Rle_refl 0) P p' Bp') as [P0' Pp'].
      apply (ever_braking v w (braking W now b) g q _ _ Ha Hb P G Q (Rlt_le _ _ HT) HA x p' X0 P0' X Pp'). }
    split.
    - intros [[Nb Gb]|[Nb V]].
      + destruct (brakes_exists v q (par "cc_ramp") (par "cc_braking") Ha Q (Rlt_le _ _ HT) HA) as [x Bx].
        exists x. split; [left; split; assumption|]. exists p. split; [exact Bp|]. apply (E x Bx p Bp). exact Gb.
      + destruct (constant_exists v Ha) as [x Bx]. exists x. split; [right; split; assumption|]. exists p. split; [exact Bp|].
        set (B := braking W now b) in *. assert (S : 0 <= w ^ 2 / (2 * B)).
        { apply Rmult_le_pos; [apply pow2_ge_0|]. left. apply Rinv_0_lt_compat. lra. }
        assert (S1 : 0 <= w / B) by (apply over_positive; lra).
        assert (S2 : 0 <= (g + w ^ 2 / (2 * B)) / v) by (apply over_positive; lra).
        exists (w / B + (g + w ^ 2 / (2 * B)) / v + 1). split; [lra|].
        assert (W1 : B * (w / B) = w) by (field; lra). assert (V1 : v * ((g + w ^ 2 / (2 * B)) / v) = g + w ^ 2 / (2 * B)) by (field; lra).
        rewrite (constant_way v x Bx) by lra. rewrite (p_stands w B Hb P p P0 Pp) by nra. nra.
    - intros [x [[[Nb Bx]|[Nb Bx]] [p' [Bp' [t [T C]]]]]].
      + left. split; [exact Nb|]. apply (E x Bx p' Bp'). exists t. split; assumption.
      + right. split; [exact Nb|]. apply Rnot_le_lt. intros V. rewrite (constant_way v x Bx) in C by assumption.
        destruct (brakes_right w 0 0 _ (Rle_refl 0) (Rle_refl 0) P p' Bp') as [P0' Pp'].
        assert (p' 0 <= p' t); [|nra].
        apply (grows p' (speed_at w 0 0 (braking W now b))); [lra|intros; apply Pp'; lra|intros; apply Rmax_l].
  Qed.
End Following.
