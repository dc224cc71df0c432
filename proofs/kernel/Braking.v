(* Vehicles that brake as Prescribed.v says.  NOT TRUSTED: proved.

   `brakes_exists` says that there is such a motion, and `brakes_right` what its speed is at every time.  The
   lemmas x_before .. x_stands_early say where it is: on its way at v, in the ramp, in full braking, standing. *)
From Coq Require Import Reals List Lra Psatz.
From Roadproof Require Import Prescribed.
From Roadproof Require Guarantee.
Import ListNotations.
Open Scope R_scope.

(* --- motions by their derivatives --- *)
Lemma same_gain f g f' a b : a <= b ->
  (forall t, a <= t <= b -> continuity_pt f t) -> (forall t, a <= t <= b -> continuity_pt g t) ->
  (forall t, a < t < b -> derivable_pt_lim f t (f' t)) -> (forall t, a < t < b -> derivable_pt_lim g t (f' t)) ->
  f b - f a = g b - g a.
Proof.
  intros L Cf Cg Df Dg. destruct (Rle_lt_or_eq_dec a b L) as [S|<-]; [|lra].
  set (h := fun t => f t - g t).
  assert (P : forall t, a < t < b -> derivable_pt h t).
  { intros t H. exists (f' t - f' t). apply derivable_pt_lim_minus; auto. }
  assert (Q : forall t, a < t < b -> derivable_pt id t) by (intros; apply derivable_pt_id).
  destruct (MVT h id a b P Q S) as [c [H E]].
  - intros t H. apply continuity_pt_minus; auto.
  - intros t _. apply derivable_continuous_pt, derivable_pt_id.
  - assert (Z : derive_pt h c (P c H) = 0).
    { apply derive_pt_eq_0. replace 0 with (f' c - f' c) by ring. apply derivable_pt_lim_minus; auto. }
    rewrite Z in E. unfold id in E at 1 2. 
    assert (I : derive_pt id c (Q c H) = 1) by (apply derive_pt_eq_0, derivable_pt_lim_id).
    rewrite I in E. unfold h in E. lra.
Qed.

Lemma cubic k a b d e t :
  derivable_pt_lim (fun t => k + a * (t - b) + d * (t - b) ^ 2 + e * (t - b) ^ 3) t (a + 2 * d * (t - b) + 3 * e * (t - b) ^ 2).
Proof.
  apply (derivable_pt_lim_ext (fun t => (fun s => (k + mult_real_fct a id s) + mult_real_fct d (fun s => s ^ 2) s
    + mult_real_fct e (fun s => s ^ 3) s) (t - b))).
  - intros s. unfold mult_real_fct, id. ring.
  - replace (a + 2 * d * (t - b) + 3 * e * (t - b) ^ 2)
      with ((0 + a * 1 + d * (INR 2 * (t - b) ^ pred 2) + e * (INR 3 * (t - b) ^ pred 3)) * (1 - 0)) by (simpl; ring).
    apply (derivable_pt_lim_comp (fun t => t - b) (fun s => (k + mult_real_fct a id s) + mult_real_fct d (fun s => s ^ 2) s
      + mult_real_fct e (fun s => s ^ 3) s)).
    + apply derivable_pt_lim_minus; [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
    + apply (derivable_pt_lim_plus (fun s => (k + mult_real_fct a id s) + mult_real_fct d (fun s => s ^ 2) s));
        [apply (derivable_pt_lim_plus (fun s => k + mult_real_fct a id s));
          [apply (derivable_pt_lim_plus (fun s => k))|]|].
      * apply derivable_pt_lim_const.
      * apply derivable_pt_lim_scal, derivable_pt_lim_id.
      * apply derivable_pt_lim_scal, derivable_pt_lim_pow.
      * apply derivable_pt_lim_scal, derivable_pt_lim_pow.
Qed.

(* a cubic over an interval *)
Lemma gains_cubic f f' a b c A1 B1 D1 : a <= b ->
  (forall t, a <= t <= b -> continuity_pt f t) ->
  (forall t, a < t < b -> derivable_pt_lim f t (f' t)) ->
  (forall t, a < t < b -> f' t = A1 + 2 * B1 * (t - c) + 3 * D1 * (t - c) ^ 2) ->
  f b = f a + A1 * (b - a) + B1 * ((b - c) ^ 2 - (a - c) ^ 2) + D1 * ((b - c) ^ 3 - (a - c) ^ 3).
Proof.
  intros L C D E.
  pose proof (same_gain f (fun t => 0 + A1 * (t - c) + B1 * (t - c) ^ 2 + D1 * (t - c) ^ 3) f' a b L C) as H.
  assert (f b - f a = 0 + A1 * (b - c) + B1 * (b - c) ^ 2 + D1 * (b - c) ^ 3
    - (0 + A1 * (a - c) + B1 * (a - c) ^ 2 + D1 * (a - c) ^ 3)); [|lra].
  apply H; [|exact D|].
  - intros t _. apply derivable_continuous_pt. eexists. apply cubic.
  - intros t T. rewrite (E t T). apply cubic.
Qed.

(* f grows, or falls *)
Lemma grows f f' a b : a <= b -> (forall t, a <= t <= b -> derivable_pt_lim f t (f' t)) ->
  (forall t, a <= t <= b -> 0 <= f' t) -> f a <= f b.
Proof.
  intros L D P. destruct (Req_dec a b) as [<-|N]; [lra|].
  destruct (MVT_cor2 f f' a b) as [c [E I]]; [lra|auto|]. 
  assert (0 <= f' c) by (apply P; lra). nra.
Qed.
Lemma falls f f' a b : a <= b -> (forall t, a <= t <= b -> derivable_pt_lim f t (f' t)) ->
  (forall t, a <= t <= b -> f' t <= 0) -> f b <= f a.
Proof.
  intros L D P. destruct (Req_dec a b) as [<-|N]; [lra|].
  destruct (MVT_cor2 f f' a b) as [c [E I]]; [lra|auto|]. 
  assert (f' c <= 0) by (apply P; lra). nra.
Qed.

Lemma below A a b : 0 < A -> 0 <= b -> A * a ^ 2 <= A * b ^ 2 -> a <= b.
Proof. intros P B H. apply Rnot_lt_le. intros N. assert (0 < A * (a - b) * (a + b)) by (repeat apply Rmult_lt_0_compat; lra). nra. Qed.
Lemma below_strictly A a b : 0 < A -> 0 <= b -> A * a ^ 2 < A * b ^ 2 -> a < b.
Proof.
  intros P B H. apply Rnot_le_lt. intros N. assert (0 <= A * (a - b) * (a + b)) by (repeat apply Rmult_le_pos; lra). nra.
Qed.

(* --- one vehicle that brakes: v at 0, from q on by A in T --- *)
Section Braking.
  Variables v q T A : R.
  Hypotheses (Hv : 0 <= v) (Hq : 0 <= q) (HT : 0 <= T) (HA : 0 < A).

  Definition lost s := if Rle_dec s 0 then 0 else if Rle_dec s T then A * s ^ 2 / (2 * T) else A * (s - T / 2).

  Lemma lost_before s : s <= 0 -> lost s = 0.
  Proof. intros S. unfold lost. destruct (Rle_dec s 0); lra. Qed.
  Lemma lost_ramp s : 0 < T -> 0 <= s <= T -> lost s = A * s ^ 2 / (2 * T).
  Proof.
    intros P S. unfold lost. destruct (Rle_dec s 0) as [Z|Z].
    - replace s with 0 by lra. field. lra.
    - destruct (Rle_dec s T); lra.
  Qed.
  Lemma lost_full s : T <= s -> lost s = A * (s - T / 2).
  Proof.
    intros S. unfold lost. destruct (Rle_dec s 0) as [Z|Z].
    - replace s with 0 by lra. replace T with 0 by lra. field.
    - destruct (Rle_dec s T); [|reflexivity]. replace s with T by lra. field. lra.
  Qed.

  Lemma taken_lost taken : taken 0 = 0 -> (forall t, 0 <= t -> continuity_pt taken t) ->
    (forall t, 0 < t -> ~ In t [q] -> derivable_pt_lim taken t (ramp T A (t - q))) ->
    forall t, 0 <= t -> taken t = lost (t - q).
  Proof.
    intros Z C D.
    assert (N : forall t, t <> q -> ~ In t [q]) by (intros t Hne [E|[]]; lra).
    assert (B : forall t, 0 <= t <= q -> taken t = 0).
    { intros t H. rewrite (gains_cubic taken (fun t => ramp T A (t - q)) 0 t 0 0 0 0); [lra|lra| | |].
      - intros u U. apply C. lra.
      - intros u U. apply D; [lra|apply N; lra].
      - intros u U. unfold ramp. destruct (Rlt_dec (u - q) 0); lra. }
    assert (R : forall t, 0 < T -> q <= t <= q + T -> taken t = A * (t - q) ^ 2 / (2 * T)).
    { intros t P H. rewrite (gains_cubic taken (fun t => ramp T A (t - q)) q t q 0 (A / (2 * T)) 0).
      - rewrite B by lra. field. lra.
      - lra.
      - intros u U. apply C. lra.
      - intros u U. apply D; [lra|apply N; lra].
      - intros u U. unfold ramp. destruct (Rlt_dec (u - q) 0); [lra|]. destruct (Rlt_dec (u - q) T); [|lra]. field. lra. }
    assert (Q : taken (q + T) = A * T / 2).
    { destruct (Rle_lt_or_eq_dec 0 T HT) as [P|<-]; [rewrite R by lra; field; lra|].
      rewrite B by lra. lra. }
    intros t H. destruct (Rle_lt_dec t q) as [L|L]; [rewrite B, lost_before by lra; reflexivity|].
    destruct (Rle_lt_dec t (q + T)) as [M|M]; [rewrite R, lost_ramp by lra; reflexivity|].
    rewrite lost_full by lra.
    rewrite (gains_cubic taken (fun t => ramp T A (t - q)) (q + T) t 0 A 0 0).
    - rewrite Q. field.
    - lra.
    - intros u U. apply C. lra.
    - intros u U. apply D; [lra|apply N; lra].
    - intros u U. unfold ramp. destruct (Rlt_dec (u - q) 0); [lra|]. destruct (Rlt_dec (u - q) T); lra.
  Qed.

  Definition speed_at t := Rmax 0 (v - lost (t - q)).
  Variable x : R -> R.
  Hypothesis X0 : x 0 = 0.
  Hypothesis X : forall t, 0 <= t -> derivable_pt_lim x t (speed_at t).

  Lemma x_continuous t : 0 <= t -> continuity_pt x t.
  Proof. intros H. apply derivable_continuous_pt. exists (speed_at t). exact (X t H). Qed.

  Lemma x_before t : 0 <= t <= q -> x t = v * t.
  Proof.
    intros H. rewrite (gains_cubic x speed_at 0 t 0 v 0 0); [lra|lra| | |].
    - intros u U. apply x_continuous. lra.
    - intros u U. apply X. lra.
    - intros u U. unfold speed_at. rewrite lost_before by lra. rewrite Rmax_right; lra.
  Qed.
  Lemma x_ramp t : 0 < T -> q <= t <= q + T -> A * (t - q) ^ 2 <= 2 * T * v -> x t = v * t - A * (t - q) ^ 3 / (6 * T).
  Proof.
    intros P H S. rewrite (gains_cubic x speed_at q t q v 0 (- A / (6 * T))).
    - rewrite x_before by lra. field. lra.
    - lra.
    - intros u U. apply x_continuous. lra.
    - intros u U. apply X. lra.
    - intros u U. unfold speed_at. rewrite lost_ramp by lra. rewrite Rmax_right; [field; lra|].
      assert (A * (u - q) ^ 2 / (2 * T) <= v); [|lra].
      apply Rmult_le_reg_r with (2 * T); [lra|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra.
      assert ((u - q) ^ 2 <= (t - q) ^ 2) by (apply pow_incr; lra). nra.
  Qed.
  Lemma x_full t : 2 * v >= A * T -> q + T <= t -> 2 * A * (t - q) <= 2 * v + A * T ->
    x t = v * t - A * (2 * (t - q) - T) ^ 2 / 8 - A * T ^ 2 / 24.
  Proof.
    intros P H S.
    assert (E : x (q + T) = v * (q + T) - A * T ^ 2 / 6).
    { destruct (Rle_lt_or_eq_dec 0 T HT) as [P'|<-].
      - rewrite x_ramp; [field; lra|lra|lra|]. replace (q + T - q) with T by ring. nra.
      - rewrite x_before by lra. lra. }
    rewrite (gains_cubic x speed_at (q + T) t (q + T / 2) v (- A / 2) 0).
    - rewrite E. field.
    - lra.
    - intros u U. apply x_continuous. lra.
    - intros u U. apply X. lra.
    - intros u U. unfold speed_at. rewrite lost_full by lra. rewrite Rmax_right; [field|]. nra.
  Qed.
  Lemma x_stands t : 2 * v >= A * T -> 2 * v + A * T <= 2 * A * (t - q) ->
    x t = v * q + v * T / 2 + v ^ 2 / (2 * A) - A * T ^ 2 / 24.
  Proof.
    intros P S. set (e := q + T / 2 + v / A).
    assert (Ae : A * (v / A) = v) by (field; lra).
    assert (L : q + T <= e) by (unfold e; nra). assert (M : e <= t) by (unfold e; nra).
    rewrite (gains_cubic x speed_at e t 0 0 0 0).
    - rewrite x_full; [unfold e; field; lra|lra|lra|unfold e; lra].
    - lra.
    - intros u U. apply x_continuous. lra.
    - intros u U. apply X. lra.
    - intros u U. unfold speed_at. rewrite lost_full by lra. rewrite Rmax_left; [field|]. unfold e in *. nra.
  Qed.
  Lemma root_of k z : 0 < k -> 0 <= z -> k * (sqrt (z / k)) ^ 2 = z.
  Proof.
    intros K Z. replace ((sqrt (z / k)) ^ 2) with (sqrt (z / k) * sqrt (z / k)) by ring. rewrite sqrt_sqrt; [field; lra|].
    apply Rmult_le_pos; [lra|]. left. apply Rinv_0_lt_compat. lra.
  Qed.
  Lemma x_stands_early t : 2 * v < A * T -> q <= t -> 2 * T * v <= A * (t - q) ^ 2 ->
    x t = v * q + 2 / 3 * v * sqrt (2 * T * v / A).
  Proof.
    intros P H S. assert (PT : 0 < T) by nra.
    set (r := sqrt (2 * T * v / A)).
    assert (Ar : A * r ^ 2 = 2 * T * v) by (apply root_of; [lra|nra]).
    assert (R0 : 0 <= r) by apply sqrt_pos.
    assert (L : r <= t - q) by (apply (below A); lra).
    assert (M : r <= T) by (apply (below A); nra).
    rewrite (gains_cubic x speed_at (q + r) t 0 0 0 0).
    - rewrite x_ramp; [|lra|lra|replace (q + r - q) with r by ring; lra].
      replace (q + r - q) with r by ring. 
      replace (A * r ^ 3) with (A * r ^ 2 * r) by ring. rewrite Ar. field. lra.
    - lra.
    - intros u U. apply x_continuous. lra.
    - intros u U. apply X. lra.
    - intros u U. unfold speed_at. rewrite Rmax_left; [field|].
      destruct (Rle_lt_dec (u - q) T) as [F|F].
      + rewrite lost_ramp by lra. assert (v <= A * (u - q) ^ 2 / (2 * T)); [|lra].
        apply Rmult_le_reg_r with (2 * T); [lra|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra.
        assert (r ^ 2 <= (u - q) ^ 2) by (apply pow_incr; lra). nra.
      + rewrite lost_full by lra. nra.
  Qed.
End Braking.

(* --- there is a motion for every braking --- *)
Lemma cubic_is k a b d e t l : l = a + 2 * d * (t - b) + 3 * e * (t - b) ^ 2 ->
  derivable_pt_lim (fun t => k + a * (t - b) + d * (t - b) ^ 2 + e * (t - b) ^ 3) t l.
Proof. intros ->. apply cubic. Qed.
Lemma continuous_ext f g t : (forall s, f s = g s) -> continuity_pt f t -> continuity_pt g t.
Proof.
  intros E C eps P. destruct (C eps P) as [d [D H]]. exists d. split; [exact D|].
  intros s S. rewrite <- !E. apply H. exact S.
Qed.
Lemma max_continuous f t : continuity_pt f t -> continuity_pt (fun t => Rmax 0 (f t)) t.
Proof.
  intros C. apply (continuous_ext (fun t => / 2 * (f t + Rabs (f t)))).
  - intros s. unfold Rmax, Rabs. destruct (Rle_dec 0 (f s)), (Rcase_abs (f s)); lra.
  - apply (continuity_pt_scal (fun t => f t + Rabs (f t)) (/ 2)), (continuity_pt_plus f (fun t => Rabs (f t))); [exact C|].
    apply (continuity_pt_comp f Rabs); [exact C|apply Rcontinuity_abs].
Qed.
Lemma primitive_exists u b : 0 <= b -> (forall t, 0 <= t -> continuity_pt u t) -> (forall t, b <= t -> u t = u b) ->
  exists x, x 0 = 0 /\ forall t, 0 <= t -> derivable_pt_lim x t (u t).
Proof.
  intros B C E. pose proof B as B'. assert (C' : forall t, 0 <= t <= b -> continuity_pt u t) by (intros; apply C; lra).
  exists (primitive B (FTC_P1 B C')). split.
  - unfold primitive. destruct (Rle_dec 0 0); [|exfalso; lra]. destruct (Rle_dec 0 b) as [L|L]; [|contradiction]. apply RiemannInt_P9.
  - intros t T. destruct (Rle_lt_dec t b) as [L|L]; [apply RiemannInt_P28; lra|].
    rewrite E by lra. set (k := RiemannInt (@FTC_P1 u 0 b B C' b B (Rle_refl b))).
    apply (derivable_pt_lim_locally_ext (fun t => k + u b * (t - b) + 0 * (t - b) ^ 2 + 0 * (t - b) ^ 3) _ t b (t + 1)); [lra| |].
    + intros z Z. unfold primitive. destruct (Rle_dec 0 z); [|exfalso; lra]. destruct (Rle_dec z b); [exfalso; lra|]. unfold k. ring.
    + apply cubic_is. ring.
Qed.
Lemma goes_exists v braking jumps taken b : taken 0 = 0 -> (forall t, 0 <= t -> continuity_pt taken t) ->
  (forall t, 0 < t -> ~ In t jumps -> derivable_pt_lim taken t (braking t)) ->
  0 <= b -> (forall t, b <= t -> Rmax 0 (v - taken t) = Rmax 0 (v - taken b)) -> exists x, goes v braking jumps x.
Proof.
  intros Z C D B E.
  destruct (primitive_exists (fun t => Rmax 0 (v - taken t)) b B) as [x [X0 X]].
  - intros t T. apply max_continuous, (continuity_pt_minus (fun _ => v) taken); [|apply C; exact T].
    apply derivable_continuous_pt, derivable_pt_const.
  - exact E.
  - exists x, taken. repeat split; auto.
Qed.

Lemma lost_slope T A s : 0 < T -> derivable_pt_lim (lost T A) s (ramp T A s).
Proof.
  intros P.
  apply (derivable_pt_lim_ext (fun t => if Rlt_dec t 0 then 0 else if Rlt_dec t T then A * t ^ 2 / (2 * T) else A * (t - T / 2))).
  - intros t. unfold lost. destruct (Rlt_dec t 0), (Rle_dec t 0), (Rlt_dec t T), (Rle_dec t T); try lra.
    + replace t with 0 by lra. field. lra.
    + replace t with T by lra. field. lra.
  - apply (Guarantee.glued (fun _ => 0) (fun t => if Rlt_dec t T then A * t ^ 2 / (2 * T) else A * (t - T / 2))
      (fun _ => 0) (fun t => if Rlt_dec t T then A * t / T else A)).
    + intros t. apply derivable_pt_lim_const.
    + intros t. apply (Guarantee.glued (fun t => A * t ^ 2 / (2 * T)) (fun t => A * (t - T / 2)) (fun t => A * t / T) (fun _ => A)).
      * intros u. apply (derivable_pt_lim_ext (fun t => 0 + 0 * (t - 0) + A / (2 * T) * (t - 0) ^ 2 + 0 * (t - 0) ^ 3));
          [intros; field; lra|].
        apply cubic_is. field. lra.
      * intros u. apply (derivable_pt_lim_ext (fun t => 0 + A * (t - T / 2) + 0 * (t - T / 2) ^ 2 + 0 * (t - T / 2) ^ 3)); [intros; ring|].
        apply cubic_is. ring.
      * field. lra.
      * field. lra.
    + destruct (Rlt_dec 0 T); [field|]; lra.
    + destruct (Rlt_dec 0 T); [field|]; lra.
Qed.
Lemma shift f q t l : derivable_pt_lim f (t - q) l -> derivable_pt_lim (fun t => f (t - q)) t l.
Proof.
  intros D. replace l with (l * (1 - 0)) by ring. apply (derivable_pt_lim_comp (fun t => t - q) f); [|exact D].
  apply derivable_pt_lim_minus; [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
Qed.
Lemma lost_at_once A s : lost 0 A s = A * Rmax 0 s.
Proof.
  unfold lost, Rmax. destruct (Rle_dec s 0), (Rle_dec 0 s); try lra. replace s with 0 by lra. ring.
Qed.

Lemma lost_slope_at_once A s : s <> 0 -> derivable_pt_lim (lost 0 A) s (ramp 0 A s).
Proof.
  intros N. unfold ramp. destruct (Rlt_dec s 0) as [L|L].
  - apply (derivable_pt_lim_locally_ext (fun _ => 0) _ _ (s - 1) 0); [lra| |apply derivable_pt_lim_const].
    intros z Z. rewrite lost_before; lra.
  - apply (derivable_pt_lim_locally_ext (fun s => 0 + A * (s - 0) + 0 * (s - 0) ^ 2 + 0 * (s - 0) ^ 3) _ _ 0 (s + 1)); [lra| |].
    + intros z Z. rewrite lost_full; lra.
    + apply cubic_is. ring.
Qed.

Section Brakes.
  Variables v q T A : R.
  Hypotheses (Hv : 0 <= v) (Hq : 0 <= q) (HT : 0 <= T) (HA : 0 < A).

  Lemma brakes_exists : exists x, brakes_from v (Some q) T A x.
  Proof.
    cbn [brakes_from]. apply (goes_exists _ _ _ (fun t => lost T A (t - q)) (q + T + v / A)).
    - apply lost_before; lra.
    - intros t _. destruct (Rle_lt_or_eq_dec 0 T HT) as [P|<-].
      + apply derivable_continuous_pt. eexists. apply shift, lost_slope. exact P.
      + apply (continuous_ext (fun t => A * Rmax 0 (t - q))); [intros; symmetry; apply lost_at_once|].
        apply (continuity_pt_scal (fun t => Rmax 0 (t - q)) A), max_continuous, derivable_continuous_pt.
        eexists. apply (derivable_pt_lim_minus id (fun _ => q)); [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
    - intros t _ N. apply shift. destruct (Rle_lt_or_eq_dec 0 T HT) as [P|<-]; [apply lost_slope; exact P|].
      apply lost_slope_at_once. intros E. apply N. left. lra.
    - assert (0 <= v / A) by (apply Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]). lra.
    - intros t L. assert (Ae : A * (v / A) = v) by (field; lra). set (e := v / A) in *. assert (0 <= e) by nra.
      rewrite !lost_full by lra. rewrite !Rmax_left; [reflexivity|nra|nra].
  Qed.
  Lemma brakes_right x : brakes_from v (Some q) T A x -> x 0 = 0 /\ forall t, 0 <= t -> derivable_pt_lim x t (speed_at v q T A t).
  Proof.
    intros [taken [Z [C [D [X0 X]]]]]. split; [exact X0|]. intros t H. unfold speed_at.
    rewrite <- (taken_lost q T A Hq HT HA taken Z C D t H). apply X. exact H.
  Qed.
End Brakes.

(* one that never brakes *)
Lemma constant_way v x : goes v (fun _ => 0) nil x -> forall t, 0 <= v -> 0 <= t -> x t = v * t.
Proof.
  intros [taken [Z [C [D [X0 X]]]]] t V T.
  assert (E : forall s, 0 <= s -> taken s = 0).
  { intros s S. rewrite (gains_cubic taken (fun _ => 0) 0 s 0 0 0 0); [lra|lra| | |].
    - intros z Hz. apply C. lra.
    - intros z Hz. apply D; [lra|intros []].
    - intros. lra. }
  rewrite (gains_cubic x (fun t => Rmax 0 (v - taken t)) 0 t 0 v 0 0); [lra|lra| | |].
  - intros z Hz. apply derivable_continuous_pt. eexists. apply X. lra.
  - intros z Hz. apply X. lra.
  - intros z Hz. rewrite E, Rmax_right by lra. lra.
Qed.
Lemma constant_exists v : 0 <= v -> exists x, goes v (fun _ => 0) nil x.
Proof.
  intros V. apply (goes_exists _ _ _ (fun _ => 0) 0); try lra.
  - intros t _. apply derivable_continuous_pt, derivable_pt_const.
  - intros t _ _. apply derivable_pt_lim_const.
  - reflexivity.
Qed.
