(* Vehicles whose speed falls in pieces, each as one that has braked so all the time.  NOT TRUSTED: proved.

   The definitions are those of driver.spec for AEB, over numbers. *)
From Coq Require Import Reals List Lra Psatz.
From Roadproof Require Import Prescribed Braking Gained.
Import ListNotations.
Open Scope R_scope.

Definition isFaster p q h W T A : Prop :=
  0 < p /\ (h <= q \/ (A * T * W ^ 2 <= 2 * p /\ 2 * A * W * (h - q) < 2 * p + A * T * W ^ 2)
            \/ (2 * p < A * T * W ^ 2 /\ A * (h - q) ^ 2 < 2 * T * p)).
Definition gainsFrom p x q W T A : Prop :=
  0 < p /\ ((A * T * W ^ 2 <= 2 * p /\ 24 * A * W * (x - p * q) < 12 * A * T * W ^ 2 * p + 12 * p ^ 2 - A ^ 2 * T ^ 2 * W ^ 4)
            \/ (2 * p < A * T * W ^ 2 /\ (x < p * q \/ 9 * A * (x - p * q) ^ 2 < 8 * T * p ^ 3))).
Definition faster q h m W T A B : R := (B * (h - m) ^ 2 - A * ((h - q) ^ 2 - Rmax (h - q - W * T) 0 ^ 2)) / (2 * T).
Definition farther q h m W T A B : R :=
  faster q h m W T A B * h - (B * (h - m) ^ 3 - A * ((h - q) ^ 3 - Rmax (h - q - W * T) 0 ^ 3)) / (6 * T).
Definition gainsOver p x q h m W T A B C : Prop :=
  (~ isFaster p q h W T A /\ gainsFrom p x q W T A)
  \/ (isFaster p q h W T A
      /\ gainsFrom (p + faster q h m W T A B) (x + farther q h m W T A B) m W (T * C / B) C).
Definition gainsOnce p x q z W T A B : Prop :=
  (~ isFaster p q z W T A /\ gainsFrom p x q W T A)
  \/ (isFaster p q z W T A
      /\ 24 * B * W * (x - p * z) + 3 * A * B * W ^ 2 * (2 * (z - q) - W * T) ^ 2 + A * B * T ^ 2 * W ^ 4
         < 3 * (2 * p - A * W * (2 * (z - q) - W * T)) ^ 2).
Definition gainsAdded p x q z m W T A B : Prop :=
  (~ isFaster p q z W T A /\ gainsFrom p x q W T A)
  \/ (isFaster p q z W T A
      /\ gainsOver (p + faster q z m W T A (A + B)) (x + farther q z m W T A (A + B)) m (q + W * T) (z - W * T * A / B) W T (A + B) B B).

(* --- a vehicle that does not get faster, against one of constant speed u --------------------------------- *)
Definition over (x : R -> R) u g : Prop := exists t, 0 <= t /\ x t - u * t > g.
Section Falling.
  Variables (u : R) (x s : R -> R).
  Hypothesis X : forall t, 0 <= t -> derivable_pt_lim x t (s t).
  Hypothesis S : forall t t', 0 <= t <= t' -> s t' <= s t.
  Lemma gain_slope t : 0 <= t -> derivable_pt_lim (fun t => x t - u * t) t (s t - u * 1).
  Proof.
    intros H. apply derivable_pt_lim_minus; [apply X; exact H|].
    apply (derivable_pt_lim_scal id u t 1), derivable_pt_lim_id.
  Qed.
  Lemma gains_until h t : u < s h -> 0 <= t <= h -> x t - u * t <= x h - u * h.
  Proof.
    intros F H. apply (grows (fun t => x t - u * t) (fun t => s t - u * 1)); [lra|intros; apply gain_slope; lra|].
    intros z Hz. pose proof (S z h ltac:(lra)). lra.
  Qed.
  Lemma loses_from h t : s h <= u -> 0 <= h <= t -> x t - u * t <= x h - u * h.
  Proof.
    intros F H. apply (falls (fun t => x t - u * t) (fun t => s t - u * 1)); [lra|intros; apply gain_slope; lra|].
    intros z Hz. pose proof (S h z ltac:(lra)). lra.
  Qed.
  Lemma over_after y g : 0 <= y ->
    ((exists t, y <= t /\ x t - u * t > g) <-> x y - u * y > g \/ (u < s y /\ over x u g)).
  Proof.
    intros Y. split.
    - intros [t [T H]]. destruct (Rlt_le_dec u (s y)) as [F|F].
      + right. split; [exact F|]. exists t. split; [lra|exact H].
      + left. pose proof (loses_from y t F ltac:(lra)). lra.
    - intros [H|[F [t [T H]]]]; [exists y; split; lra|].
      destruct (Rle_lt_dec y t) as [L|L]; [exists t; split; assumption|].
      exists y. split; [lra|]. pose proof (gains_until y t F ltac:(lra)). lra.
  Qed.
End Falling.

Section Pieces.
  Variables (u : R) (x s y r : R -> R).
  Hypothesis X : forall t, 0 <= t -> derivable_pt_lim x t (s t).
  Hypothesis S : forall t t', 0 <= t <= t' -> s t' <= s t.
  Hypothesis Y : forall t, 0 <= t -> derivable_pt_lim y t (r t).
  Hypothesis R : forall t t', 0 <= t <= t' -> r t' <= r t.
  (* between k and h x goes as y: what it gains at most it gains there *)
  Lemma over_window k h c g : 0 <= k <= h -> (forall t, k <= t <= h -> x t = y t + c) ->
    k = 0 \/ (u < s k /\ u < r k) -> s h <= u -> r h <= u -> (over x u g <-> over y u (g - c)).
  Proof.
    intros K E F Hs Hr.
    assert (clamp : forall z w, (forall t, 0 <= t -> derivable_pt_lim z t (w t)) -> (forall t t', 0 <= t <= t' -> w t' <= w t) ->
      k = 0 \/ u < w k -> w h <= u -> forall t, 0 <= t -> exists t', k <= t' <= h /\ z t - u * t <= z t' - u * t').
    { intros z w Z M F' H' t T. destruct (Rle_lt_dec h t) as [L|L].
      - exists h. split; [lra|]. apply (loses_from u z w Z M); [exact H'|lra].
      - destruct (Rle_lt_dec k t) as [N|N]; [exists t; split; lra|].
        destruct F' as [F'|F']; [lra|]. exists k. split; [lra|]. apply (gains_until u z w Z M); [exact F'|lra]. }
    split; intros [t [T H]].
    - destruct (clamp x s X S ltac:(tauto) Hs t T) as [t' [T' L]]. exists t'. split; [lra|]. rewrite (E t' T') in L. lra.
    - destruct (clamp y r Y R ltac:(tauto) Hr t T) as [t' [T' L]]. exists t'. split; [lra|]. rewrite (E t' T'). lra.
  Qed.
  Lemma over_beyond k c g : 0 <= k -> (forall t, k <= t -> x t = y t + c) -> u < s k -> u < r k ->
    (over x u g <-> over y u (g - c)).
  Proof.
    intros K E Fs Fr. split; intros [t [T H]]; destruct (Rle_lt_dec k t) as [L|L].
    - exists t. split; [lra|]. rewrite (E t L) in H. lra.
    - exists k. split; [lra|]. pose proof (gains_until u x s X S k t Fs ltac:(lra)) as M. rewrite (E k (Rle_refl k)) in M. lra.
    - exists t. split; [lra|]. rewrite (E t L). lra.
    - exists k. split; [lra|]. pose proof (gains_until u y r Y R k t Fr ltac:(lra)) as M. rewrite (E k (Rle_refl k)). lra.
  Qed.
End Pieces.

(* --- one that brakes all the time ------------------------------------------------------------------------- *)
Lemma lost_grows T A s s' : 0 <= T -> 0 < A -> s <= s' -> lost T A s <= lost T A s'.
Proof.
  intros HT HA L. destruct (Rle_lt_dec s 0) as [N|N].
  - rewrite (lost_before T A s) by lra. apply lost_positive; assumption.
  - destruct (Rle_lt_dec s' T) as [M|M].
    + rewrite !lost_ramp by lra. apply Rmult_le_compat_r; [left; apply Rinv_0_lt_compat; lra|].
      apply Rmult_le_compat_l; [lra|]. apply pow_incr. lra.
    + rewrite (lost_full T A HT s') by lra. destruct (Rle_lt_dec T s) as [K|K].
      * rewrite lost_full by lra. nra.
      * assert (PT : 0 < T) by lra. rewrite lost_ramp by lra. apply Rmult_le_reg_r with (2 * T); [lra|].
        replace (A * s ^ 2 / (2 * T) * (2 * T)) with (A * s ^ 2) by (field; lra).
        assert (s ^ 2 <= T ^ 2) by (apply pow_incr; lra).
        assert (A * s ^ 2 <= A * T ^ 2) by (apply Rmult_le_compat_l; lra).
        assert (A * T * T <= A * T * (2 * (s' - T / 2))) by (apply Rmult_le_compat_l; [apply Rmult_le_pos; lra|lra]). lra.
Qed.
Lemma speed_falls v q T A t t' : 0 <= T -> 0 < A -> t <= t' -> speed_at v q T A t' <= speed_at v q T A t.
Proof.
  intros HT HA L. unfold speed_at. apply Rmax_lub; [apply Rmax_l|]. apply Rle_trans with (2 := Rmax_r _ _).
  pose proof (lost_grows T A (t - q) (t' - q) HT HA ltac:(lra)). lra.
Qed.

Lemma still_is_faster v u q h T A : isFaster (v - u) q h 1 T A <-> stillFaster v u q h 1 T A.
Proof.
  unfold isFaster, stillFaster. split; intros [P [L|[[L K]|[L K]]]]; (split; [lra|]);
    first [left; lra|right; left; split; lra|right; right; split; lra].
Qed.

Section One.
  Variables v q T A : R.
  Hypotheses (Hv : 0 <= v) (Hq : 0 <= q) (HT : 0 <= T) (HA : 0 < A).
  Variable x : R -> R.
  Hypothesis X0 : x 0 = 0.
  Hypothesis X : forall t, 0 <= t -> derivable_pt_lim x t (speed_at v q T A t).
  Variable u : R.
  Hypothesis Hu : 0 <= u.
  Lemma from_right g : gainsFrom (v - u) g q 1 T A <-> gains v u g q 1 T A.
  Proof.
    unfold gainsFrom, gains, gainsByRamp. split.
    - intros [P [[L H]|[L H]]]; (split; [lra|]); [left; split; lra|right]. split; [lra|].
      assert (Z : g - (v - u) * q < 2 / 3 * (v - u) * sqrt (2 * T * (v - u) / A))
        by (apply below_root; [lra|lra|lra|destruct H; [left|right]; lra]).
      destruct (root_in_ramp v T A HT HA u ltac:(lra) ltac:(lra)) as [PT [_ R0]].
      split; [|destruct H; [left|right]; lra].
      assert ((v - u) * sqrt (2 * T * (v - u) / A) <= (v - u) * T) by (apply Rmult_le_compat_l; lra). lra.
    - intros [P [[L H]|[L [_ H]]]]; (split; [lra|]); [left; split; lra|right].
      split; [lra|]. destruct H; [left|right]; lra.
  Qed.
  Lemma over_right g : u < v -> (over x u g <-> gainsFrom (v - u) g q 1 T A).
  Proof.
    intros V. rewrite from_right. pose proof (meets_after v q T A HT HA u ltac:(lra)) as M.
    rewrite (gains_right v q T A Hv Hq HT HA x X0 X u Hu). set (m := meets v q T A u) in *.
    split; [|intros [_ H]; exists m; split; lra]. intros [t [H0 H]]. split; [exact V|].
    destruct (Rle_lt_dec t m) as [L|L].
    - assert (x t - u * t <= x m - u * m); [|lra].
      apply (grows (fun t => x t - u * t) (fun t => speed_at v q T A t - u * 1)); [lra|intros; apply (gained_slope v q T A x X); lra|].
      intros z Hz. pose proof (faster_until v q T A HT HA u z (Rlt_le _ _ V) ltac:(unfold m in *; lra)). lra.
    - assert (x t - u * t <= x m - u * m); [|lra].
      apply (falls (fun t => x t - u * t) (fun t => speed_at v q T A t - u * 1)); [lra|intros; apply (gained_slope v q T A x X); lra|].
      intros z Hz. pose proof (speed_falls v q T A m z HT HA ltac:(lra)).
      assert (speed_at v q T A m <= u); [|lra]. apply (slower_from v q T A HT HA u Hu); unfold m; lra.
  Qed.
  Lemma is_faster_right h : 0 <= h -> (isFaster (v - u) q h 1 T A <-> u < v /\ u < speed_at v q T A h).
  Proof.
    intros H. rewrite still_is_faster, (faster_right v q T A HT HA u h H). split; intros [V K]; (split; [exact V|]).
    - (* strictly faster before *)
      unfold speed_at. apply Rlt_le_trans with (2 := Rmax_r _ _).
      destruct (Rle_lt_dec h q) as [B|B]; [rewrite lost_before; lra|].
      destruct (Rlt_le_dec (2 * (v - u)) (A * T)) as [L|L].
      + destruct (root_in_ramp v T A HT HA u ltac:(lra) L) as [PT [Ar R0]]. rewrite meets_ramp in K by lra.
        set (z := sqrt (2 * T * (v - u) / A)) in *. rewrite lost_ramp by lra.
        assert (A * (h - q) ^ 2 / (2 * T) < v - u); [|lra].
        apply Rmult_lt_reg_r with (2 * T); [lra|]. replace (A * (h - q) ^ 2 / (2 * T) * (2 * T)) with (A * (h - q) ^ 2) by (field; lra).
        assert (0 < h - q < z) by lra. assert ((h - q) ^ 2 < z ^ 2) by nra. nra.
      + rewrite meets_full in K by lra. assert (Ae : A * ((v - u) / A) = v - u) by (field; lra).
        set (e := (v - u) / A) in *. destruct (Rle_lt_dec (h - q) T) as [F|F].
        * assert (PT : 0 < T) by lra. rewrite lost_ramp by lra.
          assert (A * (h - q) ^ 2 / (2 * T) < v - u); [|lra].
          apply Rmult_lt_reg_r with (2 * T); [lra|].
          replace (A * (h - q) ^ 2 / (2 * T) * (2 * T)) with (A * (h - q) ^ 2) by (field; lra).
          assert ((h - q) ^ 2 <= T ^ 2) by (apply pow_incr; lra).
          assert (N : A * T * T <= 2 * (v - u) * T) by (apply Rmult_le_compat_r; lra).
          destruct (Rle_lt_or_eq_dec _ _ F) as [F'|F'].
          -- assert ((h - q) ^ 2 < T ^ 2) by nra. assert (A * (h - q) ^ 2 < A * T ^ 2) by (apply Rmult_lt_compat_l; lra). lra.
          -- rewrite F'. assert (T / 2 < e) by lra. assert (A * (T / 2) < v - u) by (rewrite <- Ae; apply Rmult_lt_compat_l; lra).
             assert (A * (T / 2) * (2 * T) < (v - u) * (2 * T)) by (apply Rmult_lt_compat_r; lra). lra.
        * rewrite lost_full by lra. nra.
    - apply Rnot_le_lt. intros N. pose proof (slower_from v q T A HT HA u Hu h (Rlt_le _ _ V) N). lra.
  Qed.
End One.
