(* What a vehicle gains whose braking is joined of two ramps, as with AEB.  NOT TRUSTED: proved. *)
From Coq Require Import Reals List Lra Psatz.
From Roadproof Require Import Prescribed Braking Gained Joined.
Import ListNotations.
Open Scope R_scope.

(* --- closed forms at h --- *)
Lemma lost_closed T A s : 0 < T -> 0 <= s -> lost T A s = A * (s ^ 2 - Rmax (s - 1 * T) 0 ^ 2) / (2 * T).
Proof.
  intros PT S. destruct (Rle_lt_dec s T) as [L|L].
  - rewrite lost_ramp, Rmax_right by lra. field. lra.
  - rewrite lost_full, Rmax_left by lra. field. lra.
Qed.
Lemma way_closed v q T A x : 0 <= v -> 0 <= q -> 0 < T -> 0 < A -> x 0 = 0 ->
  (forall t, 0 <= t -> derivable_pt_lim x t (speed_at v q T A t)) ->
  forall h, q <= h -> 0 <= v - lost T A (h - q) ->
  x h = v * h - A * ((h - q) ^ 3 - Rmax (h - q - 1 * T) 0 ^ 3) / (6 * T).
Proof.
  intros Hv Hq PT HA X0 X h H M. destruct (Rle_lt_dec (h - q) T) as [L|L].
  - rewrite lost_ramp in M by lra. assert (Q : A * (h - q) ^ 2 <= 2 * T * v).
    { apply Rmult_le_reg_r with (/ (2 * T)); [apply Rinv_0_lt_compat; lra|].
      replace (2 * T * v * / (2 * T)) with v by (field; lra). unfold Rdiv in M. lra. }
    rewrite (x_ramp v q T A Hv Hq HA x X0 X h PT ltac:(lra) Q).
    rewrite Rmax_right by lra. field. lra.
  - rewrite lost_full in M by lra. assert (F : A * T <= 2 * v) by nra.
    rewrite (x_full v q T A Hv Hq (Rlt_le _ _ PT) HA x X0 X h) by lra. rewrite Rmax_left by lra. field. lra.
Qed.
Lemma shift_right v1 q T A X1 v2 m T' C X2 h u B : 0 <= v1 -> 0 <= q -> 0 < T -> 0 < A -> 0 <= v2 -> 0 <= m -> 0 < T' -> 0 < C -> 0 < B ->
  T' * B = T * C -> q <= h -> m <= h <= m + T' ->
  brakes_from v1 (Some q) T A X1 -> brakes_from v2 (Some m) T' C X2 ->
  0 <= v1 - lost T A (h - q) -> v1 - lost T A (h - q) = v2 - lost T' C (h - m) ->
  v2 - u = v1 - u + faster q h m 1 T A B /\ X2 h - X1 h = farther q h m 1 T A B.
Proof.
  intros V1 Q PT PA V2 Hm PT' PC PB E Hq Hh B1 B2 M N.
  destruct (brakes_right v1 q T A Q ltac:(lra) PA X1 B1) as [X10 D1].
  destruct (brakes_right v2 m T' C Hm ltac:(lra) PC X2 B2) as [X20 D2].
  assert (ET : T' = T * C / B) by (apply Rmult_eq_reg_r with B; [rewrite E; field; lra|lra]).
  assert (L2 : lost T' C (h - m) = B * (h - m) ^ 2 / (2 * T)).
  { rewrite lost_ramp by lra. rewrite ET. field. lra. }
  assert (L1 : lost T A (h - q) = A * ((h - q) ^ 2 - Rmax (h - q - 1 * T) 0 ^ 2) / (2 * T)) by (apply lost_closed; lra).
  assert (F : v2 - v1 = faster q h m 1 T A B).
  { unfold faster. replace (v2 - v1) with (lost T' C (h - m) - lost T A (h - q)) by lra. rewrite L1, L2. field. lra. }
  split; [lra|]. unfold farther. rewrite <- F.
  rewrite (way_closed v1 q T A X1 V1 Q PT PA X10 D1 h Hq M).
  rewrite (x_ramp v2 m T' C V2 Hm PC X2 X20 D2 h PT' ltac:(lra)).
  - rewrite ET. field. lra.
  - rewrite N, L2 in M. replace (2 * T' * v2) with (C * (2 * T * v2 / B)) by (rewrite ET; field; lra).
    apply Rmult_le_compat_l; [lra|]. apply Rmult_le_reg_r with (B / (2 * T)); [apply Rdiv_lt_0_compat; lra|].
    replace (2 * T * v2 / B * (B / (2 * T))) with v2 by (field; lra).
    replace ((h - m) ^ 2 * (B / (2 * T))) with (B * (h - m) ^ 2 / (2 * T)) by (field; lra). lra.
Qed.

Section Motion.
  Variables (v u : R) (L x : R -> R).
  Hypotheses (Hu : 0 <= u) (Z : L 0 = 0) (C : forall t, 0 <= t -> continuity_pt L t) (X0 : x 0 = 0).
  Hypothesis X : forall t, 0 <= t -> derivable_pt_lim x t (Rmax 0 (v - L t)).
  Hypothesis G : forall t t', 0 <= t <= t' -> L t <= L t'.
  Definition s t := Rmax 0 (v - L t).
  Lemma s_falls t t' : 0 <= t <= t' -> s t' <= s t.
  Proof.
    intros H. unfold s. apply Rmax_lub; [apply Rmax_l|]. apply Rle_trans with (2 := Rmax_r _ _). pose proof (G t t' H). lra.
  Qed.
  (* from k to h it goes as one that brakes from w by A' in T' since m *)
  Definition as_ k h w T' A' m : Prop := forall t, k <= t <= h -> v - L t = w - lost T' A' (t - m).
  Lemma way_as k h w T' A' m y : 0 <= k <= h -> 0 <= m -> 0 <= T' -> 0 < A' -> as_ k h w T' A' m ->
    brakes_from w (Some m) T' A' y -> forall t, k <= t <= h -> x t = y t + (x k - y k).
  Proof.
    intros K Hm HT HA E B t T. destruct (brakes_right w m T' A' Hm HT HA y B) as [Y0 Y].
    assert (Q : x t - x k = y t - y k); [|lra].
    apply (same_gain x y (speed_at w m T' A')); [lra| | | |].
    - intros z Hz. apply derivable_continuous_pt. eexists. apply X. lra.
    - intros z Hz. apply derivable_continuous_pt. eexists. apply Y. lra.
    - intros z Hz. unfold speed_at. rewrite <- (E z ltac:(lra)). apply X. lra.
    - intros z Hz. apply Y. lra.
  Qed.

  Section Two.
    Variables (k h v1 q T A c1 : R) (X1 : R -> R).
    Hypotheses (K : 0 <= k <= h) (Hq : 0 <= q <= h) (PT : 0 < T) (PA : 0 < A) (V1 : u < v1).
    Hypothesis P1 : as_ k h v1 T A q.
    Hypothesis B1 : brakes_from v1 (Some q) T A X1.
    Hypothesis E1 : x k = X1 k + c1.
    Hypothesis F1 : k = 0 \/ u < s k.
    Lemma s_is t : k <= t <= h -> s t = speed_at v1 q T A t.
    Proof. intros T'. unfold s, speed_at. rewrite (P1 t T'). reflexivity. Qed.
    Lemma D1 : X1 0 = 0 /\ forall t, 0 <= t -> derivable_pt_lim X1 t (speed_at v1 q T A t).
    Proof. apply brakes_right; [lra|lra|exact PA|exact B1]. Qed.
    Lemma slow g : s h <= u -> (over x u g <-> gainsFrom (v1 - u) (g - c1) q 1 T A).
    Proof.
      intros S. destruct D1 as [X10 D].
      rewrite <- (over_right v1 q T A ltac:(lra) ltac:(lra) ltac:(lra) PA X1 X10 D u Hu (g - c1) V1).
      apply (over_window u x s X1 (speed_at v1 q T A) X s_falls D ltac:(intros; apply speed_falls; lra) k h c1 g K).
      - intros t T'. rewrite (way_as k h v1 T A q X1 K ltac:(lra) ltac:(lra) PA P1 B1 t T'). lra.
      - destruct F1 as [F|F]; [left; exact F|right]. split; [exact F|]. rewrite <- s_is by lra. exact F.
      - exact S.
      - rewrite <- s_is by lra. exact S.
    Qed.
    Lemma faster_is : isFaster (v1 - u) q h 1 T A <-> u < s h.
    Proof.
      rewrite (is_faster_right v1 q T A ltac:(lra) PA u Hu h ltac:(lra)). rewrite s_is by lra.
      split; [intros [_ F]; exact F|intros F; split; assumption].
    Qed.
    Lemma moving : u < s h -> v - L h = v1 - lost T A (h - q) /\ u < v - L h.
    Proof.
      intros F. split; [apply P1; lra|]. unfold s, Rmax in F. destruct (Rle_dec 0 (v - L h)); lra.
    Qed.
    Lemma two g m T' B C' v2 : 0 <= m <= h -> h <= m + T' -> 0 < B -> 0 < C' -> 0 < T' -> T' * B = T * C' ->
      (forall h', h <= h' -> as_ h h' v2 T' C' m) ->
      (over x u g <-> gainsOver (v1 - u) (g - c1) q h m 1 T A B C').
    Proof.
      intros Hm Hh PB PC PT' ET P2. unfold gainsOver. rewrite faster_is.
      destruct (Rlt_le_dec u (s h)) as [F|F].
      - destruct (moving F) as [M1 M2]. pose proof (P2 h (Rle_refl h) h ltac:(lra)) as M3.
        assert (V2 : u < v2) by (pose proof (lost_positive T' C' PC (h - m)); lra).
        destruct (brakes_exists v2 m T' C' ltac:(lra) ltac:(lra) ltac:(lra) PC) as [X2 B2].
        destruct (brakes_right v2 m T' C' ltac:(lra) ltac:(lra) PC X2 B2) as [X20 D2].
        destruct (shift_right v1 q T A X1 v2 m T' C' X2 h u B) as [S1 S2]; try assumption; try lra.
        assert (TC : T * C' / B = T') by (rewrite <- ET; field; lra). rewrite TC, <- S1, <- S2.
        assert (Q : over x u g <-> over X2 u (g - (x h - X2 h))).
        { apply (over_beyond u x s X2 (speed_at v2 m T' C') X s_falls D2 ltac:(intros; apply speed_falls; lra) h); [lra| |exact F|].
          - intros t T0. apply (way_as h t v2 T' C' m X2 ltac:(lra) ltac:(lra) ltac:(lra) PC (P2 t T0) B2 t ltac:(lra)).
          - unfold speed_at. rewrite <- M3. exact F. }
        rewrite Q, (over_right v2 m T' C' ltac:(lra) ltac:(lra) ltac:(lra) PC X2 X20 D2 u Hu _ V2).
        rewrite (way_as k h v1 T A q X1 K ltac:(lra) ltac:(lra) PA P1 B1 h ltac:(lra)).
        replace (g - (X1 h + (x k - X1 k) - X2 h)) with (g - c1 + (X2 h - X1 h)) by lra.
        split; [intros H; right; split; assumption|intros [[N _]|[_ H]]; [contradiction|exact H]].
      - rewrite (slow g F). split; [intros H; left; split; [lra|exact H]|intros [[_ H]|[N _]]; [exact H|lra]].
    Qed.
    Lemma at_once g B v2 : q + T <= h -> 0 < B -> (forall h', h <= h' -> as_ h h' v2 0 B h) ->
      (over x u g <-> gainsOnce (v1 - u) (g - c1) q h 1 T A B).
    Proof.
      intros Hh PB P2. unfold gainsOnce. rewrite faster_is.
      destruct (Rlt_le_dec u (s h)) as [F|F].
      - destruct (moving F) as [M1 M2]. pose proof (P2 h (Rle_refl h) h ltac:(lra)) as M3.
        rewrite lost_before in M3 by lra. rewrite lost_full in M1 by lra.
        assert (V2 : u < v2) by lra.
        destruct (brakes_exists v2 h 0 B ltac:(lra) ltac:(lra) (Rle_refl 0) PB) as [X2 B2].
        destruct (brakes_right v2 h 0 B ltac:(lra) (Rle_refl 0) PB X2 B2) as [X20 D2].
        assert (Q : over x u g <-> over X2 u (g - (x h - X2 h))).
        { apply (over_beyond u x s X2 (speed_at v2 h 0 B) X s_falls D2 ltac:(intros; apply speed_falls; lra) h); [lra| |exact F|].
          - intros t T0. apply (way_as h t v2 0 B h X2 ltac:(lra) ltac:(lra) (Rle_refl 0) PB (P2 t T0) B2 t ltac:(lra)).
          - unfold speed_at. rewrite lost_before by lra. rewrite Rmax_right by lra. lra. }
        rewrite Q, (over_right v2 h 0 B ltac:(lra) ltac:(lra) (Rle_refl 0) PB X2 X20 D2 u Hu _ V2).
        rewrite (way_as k h v1 T A q X1 K ltac:(lra) ltac:(lra) PA P1 B1 h ltac:(lra)).
        destruct D1 as [X10 D].
        rewrite (way_closed v1 q T A X1 ltac:(lra) ltac:(lra) PT PA X10 D h ltac:(lra)) by (rewrite lost_full by lra; lra).
        rewrite Rmax_left by lra.
        rewrite (x_before v2 h 0 B ltac:(lra) X2 X20 D2 h) by lra.
        unfold gainsFrom.
        set (e := v1 - u - A * (h - q - T / 2)). assert (Ee : v2 - u = e) by (unfold e; lra). rewrite Ee.
        assert (W1 : 2 * (v1 - u) - A * 1 * (2 * (h - q) - 1 * T) = 2 * e) by (unfold e; field). rewrite W1.
        assert (W2 : g - (v1 * h - A * ((h - q) ^ 3 - (h - q - 1 * T) ^ 3) / (6 * T) + (x k - X1 k) - v2 * h) - e * h
          = g - c1 - (v1 - u) * h + A * (2 * (h - q) - T) ^ 2 / 8 + A * T ^ 2 / 24).
        { replace v2 with (e + u) by lra. rewrite E1. field. lra. }
        rewrite W2. split.
        + intros [_ [[_ H]|[N _]]]; [|lra]. right. split; [exact F|]. lra.
        + intros [[N _]|[_ H]]; [contradiction|]. split; [lra|]. left. split; [lra|]. lra.
      - rewrite (slow g F). split; [intros H; left; split; [lra|exact H]|intros [[_ H]|[N _]]; [exact H|lra]].
    Qed.
  End Two.

  (* --- of three pieces --- *)
  Lemma three q z e T A B v2 v3 m m' T' X1 g : 0 <= q -> q <= z -> z <= e -> 0 < T -> 0 < A -> 0 < B -> u < v ->
    as_ 0 z v T A q -> brakes_from v (Some q) T A X1 ->
    0 <= m <= z -> z <= m + T -> as_ z e v2 T (A + B) m ->
    0 <= m' <= e -> e <= m' + T' -> 0 < T' -> T' * B = T * B -> (forall h', e <= h' -> as_ e h' v3 T' B m') ->
    (over x u g <-> (~ isFaster (v - u) q z 1 T A /\ gainsFrom (v - u) g q 1 T A)
      \/ (isFaster (v - u) q z 1 T A
          /\ gainsOver (v - u + faster q z m 1 T A (A + B)) (g + farther q z m 1 T A (A + B)) m e m' 1 T (A + B) B B)).
  Proof.
    intros Hq Hz He PT PA PB V P1 B1 Hm Hm2 P2 Hm' He2 PT' ET P3.
    assert (B1' := B1). destruct (brakes_right v q T A Hq ltac:(lra) PA X1 B1) as [X10 D].
    assert (E1 : x 0 = X1 0 + 0) by lra.
    assert (FI : isFaster (v - u) q z 1 T A <-> u < s z) by (apply (faster_is 0 z v q T A); try assumption; lra). rewrite FI.
    destruct (Rlt_le_dec u (s z)) as [F|F].
    - assert (MM : v - L z = v - lost T A (z - q) /\ u < v - L z) by (apply (moving 0 z v q T A); try assumption; lra).
      destruct MM as [M1 M2]. pose proof (P2 z ltac:(lra)) as M3.
      assert (V2 : u < v2) by (pose proof (lost_positive T (A + B) ltac:(lra) (z - m)); lra).
      destruct (brakes_exists v2 m T (A + B) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)) as [X2 B2].
      destruct (shift_right v q T A X1 v2 m T (A + B) X2 z u (A + B)) as [S1 S2]; try assumption; try lra.
      rewrite <- S1, <- S2.
      assert (W : x z = X2 z + (X1 z - X2 z)).
      { rewrite (way_as 0 z v T A q X1 ltac:(lra) Hq ltac:(lra) PA P1 B1 z ltac:(lra)). lra. }
      assert (T2 : over x u g <-> gainsOver (v2 - u) (g - (X1 z - X2 z)) m e m' 1 T (A + B) B B).
      { apply (two z e v2 m T (A + B) (X1 z - X2 z) X2) with (T' := T') (v2 := v3); try assumption; try lra; right; exact F. }
      rewrite T2.
      replace (g + (X2 z - X1 z)) with (g - (X1 z - X2 z)) by ring.
      split; [intros H; right; split; assumption|intros [[N _]|[_ H]]; [contradiction|exact H]].
    - assert (T2 : over x u g <-> gainsFrom (v - u) (g - 0) q 1 T A).
      { apply (slow 0 z v q T A 0 X1); try assumption; try lra; left; reflexivity. }
      rewrite T2.
      replace (g - 0) with g by ring.
      split; [intros H; left; split; [lra|exact H]|intros [[_ H]|[N _]]; [exact H|lra]].
  Qed.
End Motion.
