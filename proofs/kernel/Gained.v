(* What a vehicle that brakes gains on one of constant speed.  NOT TRUSTED: proved.

   The definitions are those of driver.spec, over numbers: what is printed for Coq is compared with them again in
   each proof.  `ever` says that they tell whether it gains more than g at some time from y on. *)
From Coq Require Import Reals List Lra Psatz.
From Roadproof Require Import Prescribed Braking.
Import ListNotations.
Open Scope R_scope.
(* --- the definitions of driver.spec, over numbers; `>=` and `>` turned round --- *)
Definition hasGained v w g q y W T A : Prop :=
  (y <= q /\ W * g < (v - w) * y)
  \/ (q < y /\ y - q <= W * T /\ A * (y - q) ^ 2 <= 2 * T * v * W ^ 2
      /\ 6 * T * W ^ 3 * g < 6 * T * W ^ 2 * (v - w) * y - A * (y - q) ^ 3)
  \/ (W * T < y - q /\ A * T <= 2 * v /\ 2 * A * (y - q) <= W * (2 * v + A * T)
      /\ 24 * W ^ 2 * g < 24 * W * (v - w) * y - 3 * A * (2 * (y - q) - W * T) ^ 2 - A * T ^ 2 * W ^ 2)
  \/ (A * T <= 2 * v /\ W * (2 * v + A * T) < 2 * A * (y - q)
      /\ 24 * A * (W * g + w * y - v * q) < W * (12 * A * v * T + 12 * v ^ 2 - A ^ 2 * T ^ 2))
  \/ (2 * v < A * T /\ q < y /\ 2 * T * v * W ^ 2 < A * (y - q) ^ 2
      /\ (W * g + w * y < v * q \/ 9 * A * (W * g + w * y - v * q) ^ 2 < 8 * T * W ^ 2 * v ^ 3)).
Definition gainsByRamp u g q W T A : Prop := W * g < u * q \/ 9 * A * (W * g - u * q) ^ 2 < 8 * T * W ^ 2 * u ^ 3.
Definition gains v w g q W T A : Prop :=
  w < v /\ ((A * T <= 2 * (v - w) /\ 24 * A * (W * g - (v - w) * q)
             < W * (12 * A * (v - w) * T + 12 * (v - w) ^ 2 - A ^ 2 * T ^ 2))
    \/ (2 * (v - w) < A * T /\ 3 * (W * g - (v - w) * q) < 2 * T * W * (v - w) /\ gainsByRamp (v - w) g q W T A)).
Definition stillFaster v w q y W T A : Prop :=
  w < v /\ (y <= q \/ (A * T <= 2 * (v - w) /\ 2 * A * (y - q) < W * (2 * (v - w) + A * T))
     \/ (2 * (v - w) < A * T /\ A * (y - q) ^ 2 < 2 * T * W ^ 2 * (v - w))).
Definition hasEverGained v w g q y W T A : Prop :=
  hasGained v w g q y W T A \/ (~ stillFaster v w q y W T A /\ gains v w g q W T A).
Definition hits v w g r q y W T A : Prop :=
  ~ hasEverGained v w (g + r) q y W T A
  /\ (hasGained v w g q y W T A \/ (stillFaster v w q y W T A /\ gains v w g q W T A)).

(* --- times may be fractions of any denominator --- *)
Lemma both a b c d : (a <-> b) -> (c <-> d) -> (a /\ c <-> b /\ d). Proof. tauto. Qed.
Lemma either a b c d : (a <-> b) -> (c <-> d) -> (a \/ c <-> b \/ d). Proof. tauto. Qed.
Lemma neither a b : (a <-> b) -> (~ a <-> ~ b). Proof. tauto. Qed.
Lemma scaled_lt k a b c d : 0 < k -> a = k * c -> b = k * d -> (a < b <-> c < d).
Proof. intros K -> ->. split; intros H; [apply Rmult_lt_reg_l with k|apply Rmult_lt_compat_l]; assumption. Qed.
Lemma scaled_le k a b c d : 0 < k -> a = k * c -> b = k * d -> (a <= b <-> c <= d).
Proof. intros K -> ->. split; intros H; [apply Rmult_le_reg_l with k|apply Rmult_le_compat_l]; lra. Qed.
Ltac alike leaf :=
  repeat lazymatch goal with
    | |- _ /\ _ <-> _ /\ _ => apply both
    | |- _ \/ _ <-> _ \/ _ => apply either
    | |- ~ _ <-> ~ _ => apply neither
    end; leaf tt.
Ltac scaled k P :=
  lazymatch goal with |- _ < _ <-> _ => apply (scaled_lt k) | |- _ <= _ <-> _ => apply (scaled_le k) end; [exact P|ring|ring].

Lemma scale_gained v w g q y W T A : 0 < W -> (hasGained v w g (W * q) (W * y) W T A <-> hasGained v w g q y 1 T A).
Proof.
  intros P. assert (P2 : 0 < W ^ 2) by (apply pow_lt; lra). assert (P3 : 0 < W ^ 3) by (apply pow_lt; lra).
  assert (P1 : 0 < 1) by lra. unfold hasGained.
  alike ltac:(fun _ => first [scaled W P|scaled (W ^ 2) P2|scaled (W ^ 3) P3|scaled 1 P1]).
Qed.
Lemma scale_gains v w g q W T A : 0 < W -> (gains v w g (W * q) W T A <-> gains v w g q 1 T A).
Proof.
  intros P. assert (P2 : 0 < W ^ 2) by (apply pow_lt; lra). assert (P1 : 0 < 1) by lra. unfold gains, gainsByRamp.
  alike ltac:(fun _ => first [scaled W P|scaled (W ^ 2) P2|scaled 1 P1]).
Qed.
Lemma scale_faster v w q y W T A : 0 < W -> (stillFaster v w (W * q) (W * y) W T A <-> stillFaster v w q y 1 T A).
Proof.
  intros P. assert (P2 : 0 < W ^ 2) by (apply pow_lt; lra). assert (P1 : 0 < 1) by lra. unfold stillFaster.
  alike ltac:(fun _ => first [scaled W P|scaled (W ^ 2) P2|scaled 1 P1]).
Qed.

Lemma below_root A v T z : 0 < A -> 0 <= v -> 0 <= T ->
  (z < 2 / 3 * v * sqrt (2 * T * v / A) <-> z < 0 \/ 9 * A * z ^ 2 < 8 * T * v ^ 3).
Proof.
  intros PA PV PT. set (r := sqrt (2 * T * v / A)).
  assert (Ar : A * r ^ 2 = 2 * T * v) by (apply root_of; [lra|repeat apply Rmult_le_pos; lra]).
  assert (R0 : 0 <= r) by apply sqrt_pos.
  assert (E : 8 * T * v ^ 3 = 9 * A * (2 / 3 * v * r) ^ 2).
  { replace (9 * A * (2 / 3 * v * r) ^ 2) with (4 * v ^ 2 * (A * r ^ 2)) by field. rewrite Ar. ring. }
  assert (M : 0 <= 2 / 3 * v * r) by (repeat apply Rmult_le_pos; lra).
  rewrite E. split.
  - intros H. destruct (Rlt_le_dec z 0) as [N|N]; [left; exact N|right].
    apply Rmult_lt_compat_l; [lra|]. nra.
  - intros [H|H]; [lra|]. apply (below_strictly (9 * A)); lra.
Qed.

Section Gained.
  Variables v q T A : R.
  Hypotheses (Hv : 0 <= v) (Hq : 0 <= q) (HT : 0 <= T) (HA : 0 < A).
  Variable x : R -> R.
  Hypothesis X0 : x 0 = 0.
  Hypothesis X : forall t, 0 <= t -> derivable_pt_lim x t (speed_at v q T A t).
  Variable w : R.
  Hypothesis Hw : 0 <= w.

  Lemma cases y : y <= q
    \/ (q < y /\ y - q <= T /\ A * (y - q) ^ 2 <= 2 * T * v)
    \/ (T < y - q /\ A * T <= 2 * v /\ 2 * A * (y - q) <= 2 * v + A * T)
    \/ (A * T <= 2 * v /\ 2 * v + A * T < 2 * A * (y - q))
    \/ (2 * v < A * T /\ q < y /\ 2 * T * v < A * (y - q) ^ 2).
  Proof.
    destruct (Rle_lt_dec y q) as [B|B]; [tauto|].
    destruct (Rle_lt_dec (A * (y - q) ^ 2) (2 * T * v)) as [C|C]; destruct (Rlt_le_dec (2 * v) (A * T)) as [D|D];
      destruct (Rle_lt_dec (y - q) T) as [E|E]; destruct (Rle_lt_dec (2 * A * (y - q)) (2 * v + A * T)) as [F|F]; try tauto.
    all: exfalso; nra.
  Qed.

  Lemma gained_right g y : 0 <= y -> (hasGained v w g q y 1 T A <-> g < x y - w * y).
  Proof.
    intros Hy.
    assert (B : y <= q -> x y = v * y) by (intros; apply (x_before v q T A); auto; lra).
    assert (R : q < y -> y - q <= T -> A * (y - q) ^ 2 <= 2 * T * v -> 0 < T /\ x y = v * y - A * (y - q) ^ 3 / (6 * T)).
    { intros U1 U2 U3. split; [lra|]. apply (x_ramp v q T A); auto; lra. }
    assert (F : T < y - q -> A * T <= 2 * v -> 2 * A * (y - q) <= 2 * v + A * T ->
      x y = v * y - A * (2 * (y - q) - T) ^ 2 / 8 - A * T ^ 2 / 24) by (intros; apply (x_full v q T A); auto; lra).
    assert (S : A * T <= 2 * v -> 2 * v + A * T < 2 * A * (y - q) ->
      x y = v * q + v * T / 2 + v ^ 2 / (2 * A) - A * T ^ 2 / 24) by (intros; apply (x_stands v q T A); auto; lra).
    assert (E : 2 * v < A * T -> q < y -> 2 * T * v < A * (y - q) ^ 2 ->
      x y = v * q + 2 / 3 * v * sqrt (2 * T * v / A)) by (intros; apply (x_stands_early v q T A); auto; lra).
    assert (S' : 24 * A * (v * q + v * T / 2 + v ^ 2 / (2 * A) - A * T ^ 2 / 24)
      = 24 * A * (v * q) + (12 * A * v * T + 12 * v ^ 2 - A ^ 2 * T ^ 2)) by (field; lra).
    split.
    - unfold hasGained. intros [[U H]|[[U1 [U2 [U3 H]]]|[[U1 [U2 [U3 H]]]|[[U1 [U2 H]]|[U1 [U2 [U3 H]]]]]]].
      + rewrite B by lra. lra.
      + destruct (R ltac:(lra) ltac:(lra) ltac:(lra)) as [PT R']. rewrite R'. apply Rmult_lt_reg_l with (6 * T); [lra|].
        replace (6 * T * (v * y - A * (y - q) ^ 3 / (6 * T) - w * y)) with (6 * T * (v - w) * y - A * (y - q) ^ 3) by (field; lra). lra.
      + rewrite F by lra. lra.
      + rewrite S by lra. apply Rmult_lt_reg_l with (24 * A); [lra|]. rewrite Rmult_minus_distr_l, S'. lra.
      + rewrite E by lra. assert (g + w * y - v * q < 2 / 3 * v * sqrt (2 * T * v / A)); [|lra].
        apply below_root; try assumption. destruct H as [H|H]; [left|right]; lra.
    - intros H. unfold hasGained. destruct (cases y) as [U|[[U1 [U2 U3]]|[[U1 [U2 U3]]|[[U1 U2]|[U1 [U2 U3]]]]]].
      + left. rewrite B in H by lra. lra.
      + right; left. destruct (R ltac:(lra) ltac:(lra) ltac:(lra)) as [PT R']. rewrite R' in H. repeat split; try lra.
        apply (Rmult_lt_compat_l (6 * T)) in H; [|lra].
        replace (6 * T * (v * y - A * (y - q) ^ 3 / (6 * T) - w * y))
          with (6 * T * (v - w) * y - A * (y - q) ^ 3) in H by (field; lra). lra.
      + right; right; left. rewrite F in H by lra. repeat split; lra.
      + right; right; right; left. rewrite S in H by lra. apply (Rmult_lt_compat_l (24 * A)) in H; [|lra].
        rewrite Rmult_minus_distr_l, S' in H. repeat split; lra.
      + right; right; right; right. rewrite E in H by lra. repeat split; try lra.
        assert (Z : g + w * y - v * q < 2 / 3 * v * sqrt (2 * T * v / A)) by lra.
        apply below_root in Z; try assumption. destruct Z; [left|right]; lra.
  Qed.

  (* when SV is no faster any more *)
  Definition meets := if Rle_dec (A * T) (2 * (v - w)) then q + T / 2 + (v - w) / A else q + sqrt (2 * T * (v - w) / A).

  Lemma faster_right y : 0 <= y -> (stillFaster v w q y 1 T A <-> w < v /\ y < meets).
  Proof.
    intros Hy. unfold stillFaster, meets.
    assert (Ae : A * ((v - w) / A) = v - w) by (field; lra).
    split; intros [V H]; split; [exact V| |exact V|].
    - destruct (Rle_dec (A * T) (2 * (v - w))) as [L|L].
      + destruct H as [H|[[_ H]|[H _]]]; [|apply Rmult_lt_reg_l with (2 * A); nra|lra].
        assert (0 < (v - w) / A) by (apply Rdiv_lt_0_compat; lra). lra.
      + assert (PT : 0 < T) by nra.
        assert (Ar : A * (sqrt (2 * T * (v - w) / A)) ^ 2 = 2 * T * (v - w)) by (apply root_of; [lra|nra]).
        pose proof (sqrt_pos (2 * T * (v - w) / A)) as R0.
        destruct H as [H|[[H _]|[_ H]]]; [|lra|].
        * assert (0 < sqrt (2 * T * (v - w) / A)); [|lra]. apply sqrt_lt_R0. apply Rdiv_lt_0_compat; [|lra]. nra.
        * assert (y - q < sqrt (2 * T * (v - w) / A)); [|lra]. apply (below_strictly A); lra.
    - destruct (Rle_dec (A * T) (2 * (v - w))) as [L|L].
      + right; left. split; [lra|]. nra.
      + destruct (Rle_lt_dec y q) as [M|M]; [left; exact M|right; right]. split; [lra|].
        assert (PT : 0 < T) by nra.
        assert (Ar : A * (sqrt (2 * T * (v - w) / A)) ^ 2 = 2 * T * (v - w)) by (apply root_of; [lra|nra]).
        set (r := sqrt (2 * T * (v - w) / A)) in *. clearbody r. assert (P : 0 < y - q < r) by lra.
        assert (A * (y - q) ^ 2 < A * r ^ 2) by (apply Rmult_lt_compat_l; nra). lra.
  Qed.

  Lemma meets_full : A * T <= 2 * (v - w) -> meets = q + T / 2 + (v - w) / A.
  Proof. intros L. unfold meets. destruct (Rle_dec (A * T) (2 * (v - w))); [reflexivity|contradiction]. Qed.
  Lemma meets_ramp : 2 * (v - w) < A * T -> meets = q + sqrt (2 * T * (v - w) / A).
  Proof. intros L. unfold meets. destruct (Rle_dec (A * T) (2 * (v - w))); [lra|reflexivity]. Qed.
  Lemma root_in_ramp : w <= v -> 2 * (v - w) < A * T ->
    0 < T /\ A * (sqrt (2 * T * (v - w) / A)) ^ 2 = 2 * T * (v - w) /\ 0 <= sqrt (2 * T * (v - w) / A) <= T.
  Proof.
    intros V L. assert (PT : 0 < T) by nra.
    assert (Ar : A * (sqrt (2 * T * (v - w) / A)) ^ 2 = 2 * T * (v - w)) by (apply root_of; [lra|nra]).
    repeat split; [exact PT|exact Ar|apply sqrt_pos|]. apply (below A); [lra|lra|]. rewrite Ar. nra.
  Qed.

  Lemma meets_after : w <= v -> q <= meets.
  Proof.
    intros V. destruct (Rlt_le_dec (2 * (v - w)) (A * T)) as [L|L].
    - rewrite meets_ramp by lra. pose proof (sqrt_pos (2 * T * (v - w) / A)). lra.
    - rewrite meets_full by lra. assert (0 <= (v - w) / A); [|lra].
      apply Rmult_le_pos; [lra|]. left. apply Rinv_0_lt_compat. lra.
  Qed.

  Lemma gains_right g : gains v w g q 1 T A <-> w < v /\ g < x meets - w * meets.
  Proof.
    unfold gains, gainsByRamp. split; intros [V H]; (split; [exact V|]).
    - destruct (Rlt_le_dec (2 * (v - w)) (A * T)) as [L|L].
      + destruct H as [[H _]|[_ [_ H]]]; [lra|]. destruct (root_in_ramp ltac:(lra) L) as [PT [Ar R0]].
        assert (Z : 1 * g - (v - w) * q < 2 / 3 * (v - w) * sqrt (2 * T * (v - w) / A))
          by (apply below_root; [lra|lra|lra|destruct H; [left|right]; lra]).
        rewrite meets_ramp by lra. set (r := sqrt (2 * T * (v - w) / A)) in *.
        assert (E : q + r - q = r) by ring.
        rewrite (x_ramp v q T A Hv Hq HA x X0 X (q + r) PT ltac:(lra)) by (rewrite E, Ar; nra). rewrite E.
        replace (A * r ^ 3) with (A * r ^ 2 * r) by ring. rewrite Ar.
        replace (2 * T * (v - w) * r / (6 * T)) with ((v - w) * r / 3) by (field; lra). lra.
      + destruct H as [[_ H]|[H _]]; [|lra]. rewrite meets_full by lra.
        assert (Ae : A * ((v - w) / A) = v - w) by (field; lra).
        assert (P : 0 <= (v - w) / A) by (apply Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]).
        set (e := (v - w) / A) in *. rewrite (x_full v q T A Hv Hq HT HA x X0 X) by nra.
        apply Rmult_lt_reg_l with (24 * A); [lra|].
        assert (E : A ^ 2 * e ^ 2 = (v - w) ^ 2) by (rewrite <- Ae; ring).
        nra.
    - destruct (Rlt_le_dec (2 * (v - w)) (A * T)) as [L|L].
      + right. split; [exact L|]. destruct (root_in_ramp ltac:(lra) L) as [PT [Ar R0]].
        rewrite meets_ramp in H by lra.
        assert (Z : 1 * g - (v - w) * q < 2 / 3 * (v - w) * sqrt (2 * T * (v - w) / A)).
        { set (r := sqrt (2 * T * (v - w) / A)) in *.
          assert (E : q + r - q = r) by ring.
          rewrite (x_ramp v q T A Hv Hq HA x X0 X (q + r) PT ltac:(lra)) in H by (rewrite E, Ar; nra). rewrite E in H.
          replace (A * r ^ 3) with (A * r ^ 2 * r) in H by ring. rewrite Ar in H.
          replace (2 * T * (v - w) * r / (6 * T)) with ((v - w) * r / 3) in H by (field; lra). lra. }
        split; [nra|]. apply below_root in Z; [destruct Z; [left|right]; lra|lra|lra|lra].
      + left. split; [exact L|]. rewrite meets_full in H by lra.
        assert (Ae : A * ((v - w) / A) = v - w) by (field; lra).
        assert (P : 0 <= (v - w) / A) by (apply Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]).
        set (e := (v - w) / A) in *. rewrite (x_full v q T A Hv Hq HT HA x X0 X) in H by nra.
        apply (Rmult_lt_compat_l (24 * A)) in H; [|lra].
        assert (E : A ^ 2 * e ^ 2 = (v - w) ^ 2) by (rewrite <- Ae; ring).
        nra.
  Qed.

  Lemma lost_positive s : 0 <= lost T A s.
  Proof.
    unfold lost. destruct (Rle_dec s 0); [lra|]. destruct (Rle_dec s T).
    - apply Rmult_le_pos; [nra|]. left. apply Rinv_0_lt_compat. lra.
    - nra.
  Qed.
  Lemma ramp_taken s r : 0 < T -> A * r ^ 2 = 2 * T * (v - w) -> A * s ^ 2 / (2 * T) - (v - w) = A * (s ^ 2 - r ^ 2) / (2 * T).
  Proof. intros P E. replace (v - w) with (A * r ^ 2 / (2 * T)) by (rewrite E; field; lra). field. lra. Qed.

  Lemma faster_until t : w <= v -> t <= meets -> w <= speed_at v q T A t.
  Proof.
    intros V H. apply Rle_trans with (v - lost T A (t - q)); [|apply Rmax_r].
    destruct (Rle_lt_dec t q) as [B|B]; [rewrite lost_before; lra|].
    destruct (Rlt_le_dec (2 * (v - w)) (A * T)) as [L|L].
    - destruct (root_in_ramp V L) as [PT [Ar R0]]. rewrite meets_ramp in H by lra.
      set (r := sqrt (2 * T * (v - w) / A)) in *. rewrite lost_ramp by lra.
      pose proof (ramp_taken (t - q) r PT Ar) as E.
      assert (Z : A * ((t - q) ^ 2 - r ^ 2) / (2 * T) <= 0); [|lra].
      apply Rmult_le_reg_r with (2 * T); [lra|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra.
      assert ((t - q) ^ 2 <= r ^ 2) by (apply pow_incr; lra). nra.
    - rewrite meets_full in H by lra. assert (Ae : A * ((v - w) / A) = v - w) by (field; lra).
      set (e := (v - w) / A) in *. destruct (Rle_lt_dec (t - q) T) as [F|F].
      + assert (PT : 0 < T) by lra. rewrite lost_ramp by lra.
        assert (A * (t - q) ^ 2 / (2 * T) <= v - w); [|lra].
        apply Rmult_le_reg_r with (2 * T); [lra|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra.
        assert ((t - q) ^ 2 <= T ^ 2) by (apply pow_incr; lra). nra.
      + rewrite lost_full by lra. nra.
  Qed.
  Lemma slower_from t : w <= v -> meets <= t -> speed_at v q T A t <= w.
  Proof.
    intros V H. apply Rmax_lub; [lra|]. pose proof (meets_after V) as M.
    destruct (Rlt_le_dec (2 * (v - w)) (A * T)) as [L|L].
    - destruct (root_in_ramp V L) as [PT [Ar R0]]. rewrite meets_ramp in H by lra.
      set (r := sqrt (2 * T * (v - w) / A)) in *.
      destruct (Rle_lt_dec (t - q) T) as [F|F].
      + rewrite lost_ramp by lra.
        pose proof (ramp_taken (t - q) r PT Ar) as E.
        assert (Z : 0 <= A * ((t - q) ^ 2 - r ^ 2) / (2 * T)); [|lra].
        apply Rmult_le_pos; [|left; apply Rinv_0_lt_compat; lra].
        assert (r ^ 2 <= (t - q) ^ 2) by (apply pow_incr; lra). nra.
      + rewrite lost_full by lra. nra.
    - rewrite meets_full in H by lra. assert (Ae : A * ((v - w) / A) = v - w) by (field; lra).
      set (e := (v - w) / A) in *. rewrite lost_full; [nra|lra|nra].
  Qed.
  Lemma never_faster t : v <= w -> speed_at v q T A t <= w.
  Proof. intros V. apply Rmax_lub; [lra|]. pose proof (lost_positive (t - q)). lra. Qed.

  (* --- the boundary: there is a later time at which it has gained more than g --- *)
  Lemma gained_slope t : 0 <= t -> derivable_pt_lim (fun t => x t - w * t) t (speed_at v q T A t - w * 1).
  Proof.
    intros H. apply derivable_pt_lim_minus; [apply X; exact H|].
    apply (derivable_pt_lim_scal id w t 1), derivable_pt_lim_id.
  Qed.
  Theorem ever g y : 0 <= y ->
    ((exists t, y <= t /\ x t - w * t > g)
     <-> hasGained v w g q y 1 T A \/ (stillFaster v w q y 1 T A /\ gains v w g q 1 T A)).
  Proof.
    intros Hy. rewrite gained_right, faster_right, gains_right by exact Hy.
    set (D := fun t => x t - w * t).
    assert (later : forall t u, 0 <= t <= u -> (v <= w \/ (w <= v /\ meets <= t)) -> D u <= D t).
    { intros t u L C. apply (falls D (fun t => speed_at v q T A t - w * 1)); [lra| |].
      - intros s S. apply gained_slope. lra.
      - intros s S. destruct C as [C|[C M]]; [pose proof (never_faster s C)|pose proof (slower_from s C ltac:(lra))]; lra. }
    split.
    - intros [t [L G]]. change (g < D t) in G. change (g < D y \/ (w < v /\ y < meets) /\ w < v /\ g < D meets).
      destruct (Rle_lt_dec v w) as [V|V].
      + left. pose proof (later y t ltac:(lra) ltac:(left; lra)). lra.
      + destruct (Rle_lt_dec meets y) as [M|M].
        * left. pose proof (later y t ltac:(lra) ltac:(right; lra)). lra.
        * right. repeat split; try lra. destruct (Rle_lt_dec t meets) as [N|N].
          -- assert (D t <= D meets); [|lra]. apply (grows D (fun t => speed_at v q T A t - w * 1)); [lra| |].
             ++ intros s S. apply gained_slope. lra.
             ++ intros s S. pose proof (faster_until s ltac:(lra) ltac:(lra)). lra.
          -- pose proof (meets_after ltac:(lra)). pose proof (later meets t ltac:(lra) ltac:(right; lra)). lra.
    - intros [G|[[_ M] [_ G]]].
      + exists y. split; lra.
      + exists meets. split; lra.
  Qed.
  Theorem ever_until g y : 0 <= g -> 0 <= y ->
    ((exists t, 0 <= t <= y /\ x t - w * t > g) <-> hasEverGained v w g q y 1 T A).
  Proof.
    intros Hg Hy. unfold hasEverGained. rewrite gained_right, faster_right, gains_right by exact Hy.
    set (D := fun t => x t - w * t). assert (Z : D 0 = 0) by (unfold D; lra).
    assert (falling : forall t u, 0 <= t <= u -> (v <= w \/ (w <= v /\ meets <= t)) -> D u <= D t).
    { intros t u L C. apply (falls D (fun t => speed_at v q T A t - w * 1)); [lra| |].
      - intros s S. apply gained_slope. lra.
      - intros s S. destruct C as [C|[C M]]; [pose proof (never_faster s C)|pose proof (slower_from s C ltac:(lra))]; lra. }
    assert (growing : forall t u, 0 <= t <= u -> w <= v -> u <= meets -> D t <= D u).
    { intros t u L V M. apply (grows D (fun t => speed_at v q T A t - w * 1)); [lra| |].
      - intros s S. apply gained_slope. lra.
      - intros s S. pose proof (faster_until s V ltac:(lra)). lra. }
    split.
    - intros [t [L G]]. change (g < D t) in G. change (g < D y \/ ~ (w < v /\ y < meets) /\ w < v /\ g < D meets).
      destruct (Rle_lt_dec v w) as [V|V]; [pose proof (falling 0 t ltac:(lra) ltac:(left; lra)); lra|].
      destruct (Rlt_le_dec y meets) as [M|M].
      + left. pose proof (growing t y ltac:(lra) ltac:(lra) ltac:(lra)). lra.
      + right. repeat split; [lra|exact V|]. destruct (Rle_lt_dec t meets) as [N|N].
        * pose proof (growing t meets ltac:(lra) ltac:(lra) ltac:(lra)). lra.
        * pose proof (meets_after ltac:(lra)). pose proof (falling meets t ltac:(lra) ltac:(right; lra)). lra.
    - intros [G|[N [V G]]]; [exists y; split; lra|]. pose proof (meets_after ltac:(lra)).
      assert (meets <= y) by (apply Rnot_lt_le; intros B; apply N; split; assumption). exists meets. split; lra.
  Qed.
  Theorem ever_from_0 g : 0 <= g -> ((exists t, 0 <= t /\ x t - w * t > g) <-> gains v w g q 1 T A).
  Proof.
    intros Hg. rewrite (ever g 0) by lra. rewrite gained_right, faster_right, gains_right by lra. rewrite X0.
    split; [intros [G|[_ G]]; [lra|exact G]|].
    intros [V G]. right. repeat split; try lra. pose proof (meets_after ltac:(lra)) as M.
    destruct (Rle_lt_or_eq_dec 0 meets ltac:(lra)) as [P|P]; [exact P|]. rewrite <- P, X0 in G. lra.
  Qed.
End Gained.
