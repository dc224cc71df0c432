(* The boundaries of the careful driver with AEB.  NOT TRUSTED: proved. *)
From Coq Require Import Reals String List Lra Psatz.
From Roadproof Require Import Meaning Prescribed Braking Gained Boundary Joined Aided.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Definition aidedGains (k : aeb) p x q z W T A B : Prop :=
  match k with
  | in_place =>
      (z <= q /\ gainsFrom p x z W T B) \/ (q < z /\ z <= q + W * T /\ gainsOver p x q z q W T A B B)
      \/ (q + W * T < z /\ gainsOnce p x q z W T A B)
  | greater =>
      (z <= q /\ gainsFrom p x z W T B)
      \/ (q < z /\ B * (z - q) <= W * T * (B - A)
          /\ gainsOver (p * (B - A) ^ 2) (x * (B - A) ^ 3) (q * (B - A)) (B * z - A * q) (z * (B - A)) (W * (B - A)) T A B B)
      \/ (q < z /\ W * T * (B - A) < B * (z - q) /\ gainsOver p x q (z + W * T * A / B) z W T A B B)
  | together =>
      (z + W * T <= q /\ gainsFrom p x z W T B)
      \/ (z <= q /\ q < z + W * T /\ gainsOver p x z q ((A * q + B * z) / (A + B)) W T B (A + B) B)
      \/ (q < z /\ B * (z - q) <= W * T * A /\ gainsOver p x q z ((A * q + B * z) / (A + B)) W T A (A + B) B)
      \/ (W * T * A < B * (z - q) /\ z < q + W * T /\ gainsAdded p x q z ((A * q + B * z) / (A + B)) W T A B)
      \/ (q + W * T <= z /\ gainsOver p x q z (z - W * T * A / B) W T A B B)
  end.

(* --- times may be fractions of any denominator ----------------------------------------------------------- *)
Section Scale.
  Variables (W T : R).
  Hypothesis P : 0 < W.
  Lemma scale_max a : Rmax (W * a) 0 = W * Rmax a 0.
  Proof. rewrite <- (Rmult_0_r W) at 1. apply RmaxRmult. lra. Qed.
  Lemma scale_is_faster p q h A : isFaster (p * W ^ 2) (W * q) (W * h) W T A <-> isFaster p q h 1 T A.
  Proof.
    assert (P2 : 0 < W ^ 2) by (apply pow_lt; lra). unfold isFaster.
    alike ltac:(fun _ => first [scaled W P|scaled (W ^ 2) P2]).
  Qed.
  Lemma scale_from p x q T' A : gainsFrom (p * W ^ 2) (x * W ^ 3) (W * q) W T' A <-> gainsFrom p x q 1 T' A.
  Proof.
    assert (P2 : 0 < W ^ 2) by (apply pow_lt; lra). assert (P3 : 0 < W ^ 3) by (apply pow_lt; lra).
    assert (P4 : 0 < W ^ 4) by (apply pow_lt; lra). assert (P6 : 0 < W ^ 6) by (apply pow_lt; lra). unfold gainsFrom.
    alike ltac:(fun _ => first [scaled (W ^ 2) P2|scaled (W ^ 3) P3|scaled (W ^ 4) P4|scaled (W ^ 6) P6]).
  Qed.
  Hypothesis PT : 0 < T.
  Lemma scale_fast q h m A B : faster (W * q) (W * h) (W * m) W T A B = faster q h m 1 T A B * W ^ 2.
  Proof.
    unfold faster. replace (W * h - W * q - W * T) with (W * (h - q - 1 * T)) by ring. rewrite scale_max. field. lra.
  Qed.
  Lemma scale_far q h m A B : farther (W * q) (W * h) (W * m) W T A B = farther q h m 1 T A B * W ^ 3.
  Proof.
    unfold farther. rewrite scale_fast. replace (W * h - W * q - W * T) with (W * (h - q - 1 * T)) by ring. rewrite scale_max.
    field. lra.
  Qed.
  Lemma scale_over p x q h m A B C :
    gainsOver (p * W ^ 2) (x * W ^ 3) (W * q) (W * h) (W * m) W T A B C <-> gainsOver p x q h m 1 T A B C.
  Proof.
    unfold gainsOver. rewrite scale_fast, scale_far, <- !Rmult_plus_distr_r, scale_is_faster, !scale_from. reflexivity.
  Qed.
  Lemma scale_once p x q z A B : gainsOnce (p * W ^ 2) (x * W ^ 3) (W * q) (W * z) W T A B <-> gainsOnce p x q z 1 T A B.
  Proof.
    assert (P4 : 0 < W ^ 4) by (apply pow_lt; lra). unfold gainsOnce. rewrite scale_is_faster, scale_from.
    apply either; [reflexivity|]. apply both; [reflexivity|]. scaled (W ^ 4) P4.
  Qed.
  Lemma scale_added p x q z m A B : 0 < B ->
    (gainsAdded (p * W ^ 2) (x * W ^ 3) (W * q) (W * z) (W * m) W T A B <-> gainsAdded p x q z m 1 T A B).
  Proof.
    intros PB. unfold gainsAdded. rewrite scale_fast, scale_far, <- !Rmult_plus_distr_r, scale_is_faster, scale_from.
    replace (W * q + W * T) with (W * (q + 1 * T)) by ring. replace (W * z - W * T * A / B) with (W * (z - 1 * T * A / B)) by (field; lra).
    rewrite scale_over. reflexivity.
  Qed.
End Scale.

(* the same at W = 1 *)
Definition aided k p x q z T A B : Prop :=
  match k with
  | in_place =>
      (z <= q /\ gainsFrom p x z 1 T B) \/ (q < z /\ z <= q + T /\ gainsOver p x q z q 1 T A B B)
      \/ (q + T < z /\ gainsOnce p x q z 1 T A B)
  | greater =>
      (z <= q /\ gainsFrom p x z 1 T B)
      \/ (q < z /\ B * (z - q) <= T * (B - A) /\ gainsOver p x q ((B * z - A * q) / (B - A)) z 1 T A B B)
      \/ (q < z /\ T * (B - A) < B * (z - q) /\ gainsOver p x q (z + T * A / B) z 1 T A B B)
  | together =>
      (z + T <= q /\ gainsFrom p x z 1 T B)
      \/ (z <= q /\ q < z + T /\ gainsOver p x z q ((A * q + B * z) / (A + B)) 1 T B (A + B) B)
      \/ (q < z /\ B * (z - q) <= T * A /\ gainsOver p x q z ((A * q + B * z) / (A + B)) 1 T A (A + B) B)
      \/ (T * A < B * (z - q) /\ z < q + T /\ gainsAdded p x q z ((A * q + B * z) / (A + B)) 1 T A B)
      \/ (q + T <= z /\ gainsOver p x q z (z - T * A / B) 1 T A B B)
  end.
Lemma scale_aided W T k p x q z A B : 0 < W -> 0 < T -> 0 < A -> 0 < B ->
  (aidedGains k (p * W ^ 2) (x * W ^ 3) (W * q) (W * z) W T A B <-> aided k p x q z T A B).
Proof.
  intros P PT PA PB. assert (P1 : 0 < 1) by lra. unfold aidedGains, aided. destruct k.
  - rewrite (scale_from W P), (scale_over W T P PT), (scale_once W T P).
    alike ltac:(fun _ => first [reflexivity|scaled W P]).
  - replace (W * z + W * T * A / B) with (W * (z + T * A / B)) by (field; lra).
    rewrite (scale_from W P), (scale_over W T P PT). destruct (Rlt_le_dec A B) as [L|L].
    + assert (P' : 0 < W * (B - A)) by (apply Rmult_lt_0_compat; lra).
      replace (p * W ^ 2 * (B - A) ^ 2) with (p * (W * (B - A)) ^ 2) by ring.
      replace (x * W ^ 3 * (B - A) ^ 3) with (x * (W * (B - A)) ^ 3) by ring.
      replace (W * q * (B - A)) with (W * (B - A) * q) by ring.
      replace (B * (W * z) - A * (W * q)) with (W * (B - A) * ((B * z - A * q) / (B - A))) by (field; lra).
      replace (W * z * (B - A)) with (W * (B - A) * z) by ring.
      rewrite (scale_over (W * (B - A)) T P' PT). alike ltac:(fun _ => first [reflexivity|scaled W P]).
    + assert (N : q < z -> ~ B * (z - q) <= T * (B - A)).
      { intros Q. assert (0 < B * (z - q)) by (apply Rmult_lt_0_compat; lra).
        assert (0 <= T * (A - B)) by (apply Rmult_le_pos; lra). lra. }
      assert (E1 : W * q < W * z <-> q < z) by (scaled W P). rewrite E1.
      assert (E2 : B * (W * z - W * q) <= W * T * (B - A) <-> B * (z - q) <= T * (B - A)) by (scaled W P). rewrite E2.
      assert (E3 : W * T * (B - A) < B * (W * z - W * q) <-> T * (B - A) < B * (z - q)) by (scaled W P). rewrite E3.
      assert (E4 : W * z <= W * q <-> z <= q) by (scaled W P). rewrite E4.
      tauto.
  - replace ((A * (W * q) + B * (W * z)) / (A + B)) with (W * ((A * q + B * z) / (A + B))) by (field; lra).
    replace (W * z - W * T * A / B) with (W * (z - T * A / B)) by (field; lra).
    rewrite (scale_from W P), !(scale_over W T P PT), (scale_added W T P PT) by lra.
    alike ltac:(fun _ => first [reflexivity|scaled W P]).
Qed.

(* --- speed that braking has taken, with one jump at z ------------------------------------------------------ *)
Lemma rise_open f f' a b : a <= b -> (forall t, a <= t <= b -> continuity_pt f t) ->
  (forall t, a < t < b -> derivable_pt_lim f t (f' t)) -> (forall t, a < t < b -> 0 <= f' t) -> f a <= f b.
Proof.
  intros L C D P. destruct (Rle_lt_or_eq_dec a b L) as [S|<-]; [|lra].
  assert (Q : forall t, a < t < b -> derivable_pt f t) by (intros t H; exists (f' t); apply D; exact H).
  assert (I : forall t, a < t < b -> derivable_pt id t) by (intros; apply derivable_pt_id).
  destruct (MVT f id a b Q I S) as [c [H E]]; [exact C|intros t _; apply derivable_continuous_pt, derivable_pt_id|].
  assert (E1 : derive_pt f c (Q c H) = f' c) by (apply derive_pt_eq_0, D, H).
  assert (E2 : derive_pt id c (I c H) = 1) by (apply derive_pt_eq_0, derivable_pt_lim_id).
  rewrite E1, E2 in E. unfold id in E. pose proof (P c H). nra.
Qed.
Lemma rise_but z f f' a b : a <= b -> (forall t, a <= t <= b -> continuity_pt f t) ->
  (forall t, a < t < b -> t <> z -> derivable_pt_lim f t (f' t)) -> (forall t, a < t < b -> 0 <= f' t) -> f a <= f b.
Proof.
  intros L C D P. set (c := Rmax a (Rmin b z)).
  assert (c <= b) by (apply Rmax_lub; [exact L|apply Rmin_l]). assert (a <= c) by apply Rmax_l.
  assert (N : forall t, a < t < b -> t <> c -> t <> z).
  { intros t H1 H2 E. apply H2. unfold c. rewrite E, Rmin_right, Rmax_right; lra. }
  apply Rle_trans with (f c).
  - apply (rise_open f f'); [lra|intros; apply C; lra| |intros; apply P; lra]. intros t H1. apply D; [lra|]. apply N; lra.
  - apply (rise_open f f'); [lra|intros; apply C; lra| |intros; apply P; lra]. intros t H1. apply D; [lra|]. apply N; lra.
Qed.

Lemma ramp_low T A s : 0 < T -> s <= 0 -> ramp T A s = 0.
Proof.
  intros P S. unfold ramp. destruct (Rlt_dec s 0); [reflexivity|]. destruct (Rlt_dec s T); [|lra].
  replace s with 0 by lra. field. lra.
Qed.
Lemma ramp_line T A s : 0 < T -> 0 <= s <= T -> ramp T A s = A * s / T.
Proof.
  intros P S. unfold ramp. destruct (Rlt_dec s 0); [lra|]. destruct (Rlt_dec s T); [reflexivity|].
  replace s with T by lra. field. lra.
Qed.
Lemma ramp_full T A s : T <= s -> 0 < T -> ramp T A s = A.
Proof. intros S P. unfold ramp. destruct (Rlt_dec s 0); [lra|]. destruct (Rlt_dec s T); lra. Qed.
Lemma frac_le T x y : 0 < T -> x <= y -> x / T <= y / T.
Proof. intros P H. apply Rmult_le_compat_r; [left; apply Rinv_0_lt_compat; lra|exact H]. Qed.
Lemma ramp_is T A s : 0 < T -> (s <= 0 /\ ramp T A s = 0) \/ (0 <= s <= T /\ ramp T A s = A * s / T) \/ (T <= s /\ ramp T A s = A).
Proof.
  intros P. destruct (Rle_lt_dec s 0) as [L|L]; [left; split; [exact L|apply ramp_low; assumption]|right].
  destruct (Rle_lt_dec s T) as [M|M]; [left; split; [lra|apply ramp_line; lra]|right; split; [lra|apply ramp_full; lra]].
Qed.
Lemma ramp_positive T A s : 0 < T -> 0 < A -> 0 <= ramp T A s <= A.
Proof.
  intros P Q. destruct (ramp_is T A s P) as [[L E]|[[L E]|[L E]]]; rewrite E; try lra.
  pose proof (frac_le T 0 (A * s) P ltac:(nra)) as F1. pose proof (frac_le T (A * s) (A * T) P ltac:(nra)) as F2.
  replace (A * T / T) with A in F2 by (field; lra). unfold Rdiv in F1 at 1. lra.
Qed.
Lemma ramp_under T A s : 0 < T -> 0 < A -> 0 <= s -> ramp T A s <= A * s / T.
Proof.
  intros P Q S. destruct (ramp_is T A s P) as [[L E]|[[L E]|[L E]]]; rewrite E.
  - replace s with 0 by lra. unfold Rdiv. lra.
  - lra.
  - pose proof (frac_le T (A * T) (A * s) P ltac:(nra)) as F. replace (A * T / T) with A in F by (field; lra). exact F.
Qed.

Section With.
  Variables (W : world).
  Notation T := (parameter W "cc_ramp").
  Notation A := (parameter W "cc_braking").
  Notation B := (parameter W "aeb_braking").
  Hypotheses (PT : 0 < T) (PA : 0 < A) (AB : A <= B).
  Variables (k : aeb) (v u q z : R) (L x : R -> R).
  Hypotheses (Hu : 0 <= u) (V : u < v) (Hq : 0 <= q) (Hz : 0 <= z).
  Hypotheses (Z : L 0 = 0) (C : forall t, 0 <= t -> continuity_pt L t) (X0 : x 0 = 0).
  Hypothesis D : forall t, 0 < t -> t <> z -> derivable_pt_lim L t (assisted W k (Some q) z t).
  Hypothesis X : forall t, 0 <= t -> derivable_pt_lim x t (Rmax 0 (v - L t)).
  Notation own t := (ramp T A (t - q)).
  Notation by_aeb m t := (ramp T B (t - m)).

  Lemma at_least_own t : 0 <= own t <= assisted W k (Some q) z t.
  Proof.
    pose proof (ramp_positive T A (t - q) PT PA) as O. split; [apply O|]. unfold assisted, Prescribed.par. destruct k.
    - destruct (Rlt_dec t z); [lra|].
      destruct (Rle_lt_dec q z) as [M|M]; [rewrite Rmin_left by lra|rewrite Rmin_right by lra].
      + destruct (ramp_is T A (t - q) PT) as [[N E]|[[N E]|[N E]]]; rewrite E.
        * apply ramp_positive; lra.
        * rewrite ramp_line by lra. apply frac_le; [exact PT|nra].
        * rewrite ramp_full by lra. exact AB.
      + destruct (ramp_is T A (t - q) PT) as [[N E]|[[N E]|[N E]]]; rewrite E.
        * apply ramp_positive; lra.
        * destruct (Rle_lt_dec (t - z) T) as [F|F]; [rewrite ramp_line by lra; apply frac_le; [exact PT|nra]|].
          rewrite ramp_full by lra. pose proof (ramp_positive T A (t - q) PT PA) as O'. rewrite E in O'. lra.
        * rewrite ramp_full by lra. exact AB.
    - apply Rmax_l.
    - pose proof (ramp_positive T B (t - z) PT ltac:(lra)). apply Rmin_glb; lra.
  Qed.
  Lemma L_grows t t' : 0 <= t <= t' -> L t <= L t'.
  Proof.
    intros H. apply (rise_but z L (assisted W k (Some q) z)); [lra|intros; apply C; lra|intros; apply D; lra|].
    intros y Hy. pose proof (at_least_own y). lra.
  Qed.
  Lemma L_at_least t : 0 <= t -> lost T A (t - q) <= L t.
  Proof.
    intros H. assert (K : L 0 - lost T A (0 - q) <= L t - lost T A (t - q)); [|rewrite Z, lost_before in K by lra; lra].
    apply (rise_but z (fun t => L t - lost T A (t - q)) (fun t => assisted W k (Some q) z t - own t)); [exact H| | |].
    - intros y Hy. apply (continuity_pt_minus L (fun t => lost T A (t - q))); [apply C; lra|].
      apply derivable_continuous_pt. eexists. apply shift, lost_slope. exact PT.
    - intros y Hy N. apply (derivable_pt_lim_minus L (fun t => lost T A (t - q))); [apply D; lra|]. apply shift, lost_slope. exact PT.
    - intros y Hy. pose proof (at_least_own y). lra.
  Qed.

  (* between i and j braking is one ramp, where it may jump at z *)
  Lemma piece_but i j T' A' m : 0 <= i <= j -> 0 < T' ->
    (forall t, i < t < j -> t <> z -> assisted W k (Some q) z t = ramp T' A' (t - m)) ->
    as_ v L i j (v - L i + lost T' A' (i - m)) T' A' m.
  Proof.
    intros H PT' E t Ht.
    assert (step : forall y y', i <= y <= y' -> y' <= j -> (y' <= z \/ z <= y) ->
      L y' - L y = lost T' A' (y' - m) - lost T' A' (y - m)).
    { intros y y' Hy Hy' N. apply (same_gain L (fun t => lost T' A' (t - m)) (fun t => ramp T' A' (t - m))); [lra| | | |].
      - intros s S. apply C. lra.
      - intros s S. apply derivable_continuous_pt. eexists. apply shift, lost_slope. exact PT'.
      - intros s S. rewrite <- E by lra. apply D; lra.
      - intros s S. apply shift, lost_slope. exact PT'. }
    destruct (Rle_lt_dec t z) as [N|N]; [pose proof (step i t ltac:(lra) ltac:(lra) ltac:(left; lra)); lra|].
    destruct (Rle_lt_dec z i) as [M|M]; [pose proof (step i t ltac:(lra) ltac:(lra) ltac:(right; lra)); lra|].
    pose proof (step i z ltac:(lra) ltac:(lra) ltac:(left; lra)). pose proof (step z t ltac:(lra) ltac:(lra) ltac:(right; lra)). lra.
  Qed.
  Lemma from_0 j T' A' m : 0 <= j -> 0 < T' -> 0 <= m ->
    (forall t, 0 < t < j -> t <> z -> assisted W k (Some q) z t = ramp T' A' (t - m)) -> as_ v L 0 j v T' A' m.
  Proof.
    intros H PT' Hm E. pose proof (piece_but 0 j T' A' m ltac:(lra) PT' E) as P.
    replace (v - L 0 + lost T' A' (0 - m)) with v in P by (rewrite Z, lost_before by lra; ring). exact P.
  Qed.
  Lemma from_on i T' A' m : 0 <= i -> 0 < T' ->
    (forall t, i < t -> t <> z -> assisted W k (Some q) z t = ramp T' A' (t - m)) ->
    forall j, i <= j -> as_ v L i j (v - L i + lost T' A' (i - m)) T' A' m.
  Proof. intros H PT' E j J. apply piece_but; [lra|exact PT'|]. intros t Ht N. apply E; lra. Qed.

  (* one ramp all along *)
  Lemma alone A' m g : 0 < A' -> 0 <= m -> (forall t, 0 < t -> t <> z -> assisted W k (Some q) z t = ramp T A' (t - m)) ->
    (over x u g <-> gainsFrom (v - u) g m 1 T A').
  Proof.
    intros PA' Hm E. apply (over_right v m T A' ltac:(lra) Hm ltac:(lra) PA' x X0); [|exact Hu|exact V].
    intros t Ht. unfold speed_at. rewrite <- (from_0 t T A' m Ht PT Hm ltac:(intros; apply E; lra) t ltac:(lra)). apply X. exact Ht.
  Qed.
  (* one ramp up to h, and then another *)
  Lemma joined A' q' h m T' B' C' g : 0 < A' -> 0 <= q' <= h -> 0 <= m <= h -> h <= m + T' -> 0 < B' -> 0 < C' -> 0 < T' ->
    T' * B' = T * C' ->
    (forall t, 0 < t < h -> t <> z -> assisted W k (Some q) z t = ramp T A' (t - q')) ->
    (forall t, h < t -> t <> z -> assisted W k (Some q) z t = ramp T' C' (t - m)) ->
    (over x u g <-> gainsOver (v - u) g q' h m 1 T A' B' C').
  Proof.
    intros PA' Hq' Hm Hh PB PC PT' E E1 E2.
    destruct (brakes_exists v q' T A' ltac:(lra) ltac:(lra) ltac:(lra) PA') as [X1 B1].
    destruct (brakes_right v q' T A' ltac:(lra) ltac:(lra) PA' X1 B1) as [X10 _].
    replace g with (g - 0) at 2 by ring.
    apply (two v u L x Hu X L_grows 0 h v q' T A' 0 X1) with (T' := T') (v2 := v - L h + lost T' C' (h - m)); try assumption; try lra.
    - apply from_0; [lra|exact PT|lra|exact E1].
    - apply from_on; [lra|exact PT'|exact E2].
  Qed.

  Lemma in_place_right g : k = in_place -> (over x u g <-> aided k (v - u) g q z T A B).
  Proof.
    intros K. rewrite K. unfold aided.
    assert (E : forall t, assisted W k (Some q) z t = if Rlt_dec t z then own t else by_aeb (Rmin q z) t)
      by (intros; rewrite K; reflexivity).
    assert (PB : 0 < B) by lra.
    destruct (Rle_lt_dec z q) as [M|M]; [|destruct (Rle_lt_dec z (q + T)) as [N|N]].
    - rewrite (alone B z g PB Hz); [split; [intros; left; split; assumption|intros [[_ H]|[[H _]|[H _]]]; [exact H|lra|lra]]|].
      intros t H1 H2. rewrite E, Rmin_right by lra. destruct (Rlt_dec t z); [|reflexivity].
      rewrite !ramp_low by lra. reflexivity.
    - rewrite (joined A q z q T B B g PA); try lra;
        [split; [intros; right; left; repeat split; assumption|intros [[H _]|[[_ [_ H]]|[H _]]]; [lra|exact H|lra]]| |].
      + intros t H1 H2. rewrite E. destruct (Rlt_dec t z); [reflexivity|lra].
      + intros t H1 H2. rewrite E, Rmin_left by lra. destruct (Rlt_dec t z); [lra|reflexivity].
    - destruct (brakes_exists v q T A ltac:(lra) Hq ltac:(lra) PA) as [X1 B1].
      destruct (brakes_right v q T A Hq ltac:(lra) PA X1 B1) as [X10 _].
      assert (O : over x u g <-> gainsOnce (v - u) (g - 0) q z 1 T A B).
      { apply (at_once v u L x Hu X L_grows 0 z v q T A 0 X1) with (v2 := v - L z); try assumption; try lra.
        - apply from_0; [lra|exact PT|lra|]. intros t H1 H2. rewrite E. destruct (Rlt_dec t z); [reflexivity|lra].
        - intros j J t Ht. rewrite lost_full by lra. 
          rewrite (gains_cubic L (assisted W k (Some q) z) z t z B 0 0); [field|lra|intros; apply C; lra|intros; apply D; lra|].
          intros y Hy. rewrite E, Rmin_left by lra. destruct (Rlt_dec y z); [lra|]. rewrite ramp_full by lra. ring. }
      replace (g - 0) with g in O by ring. rewrite O.
      split; [intros; right; right; split; assumption|intros [[H _]|[[_ [H _]]|[_ H]]]; [lra|lra|exact H]].
  Qed.

  Lemma greater_right g : k = greater -> (over x u g <-> aided k (v - u) g q z T A B).
  Proof.
    intros K. rewrite K. unfold aided.
    assert (E : forall t, assisted W k (Some q) z t = Rmax (own t) (by_aeb z t)) by (intros; rewrite K; reflexivity).
    assert (PB : 0 < B) by lra.
    destruct (Rle_lt_dec z q) as [M|M]; [|destruct (Rle_lt_dec (B * (z - q)) (T * (B - A))) as [N|N]].
    - rewrite (alone B z g PB Hz); [split; [intros; left; split; assumption|intros [[_ H]|[[H _]|[H _]]]; [exact H|lra|lra]]|].
      intros t H1 H2. rewrite E. apply Rmax_right.
      destruct (ramp_is T A (t - q) PT) as [[I F]|[[I F]|[I F]]]; rewrite F.
      + apply ramp_positive; lra.
      + destruct (Rle_lt_dec (t - z) T) as [G|G].
        * rewrite ramp_line by lra. apply frac_le; [exact PT|nra].
        * rewrite ramp_full by lra. pose proof (ramp_positive T A (t - q) PT PA). lra.
      + rewrite ramp_full by lra. exact AB.
    - assert (P : 0 < B - A).
      { assert (0 < B * (z - q)) by (apply Rmult_lt_0_compat; lra). apply Rnot_le_lt. intros F.
        assert (0 <= T * (A - B)) by (apply Rmult_le_pos; lra). lra. }
      set (h := (B * z - A * q) / (B - A)). assert (Eh : (B - A) * h = B * z - A * q) by (unfold h; field; lra).
      assert (H1 : z <= h) by nra. assert (H2 : h <= q + T) by nra.
      rewrite (joined A q h z T B B g PA); try lra;
        [split; [intros; right; left; repeat split; assumption|intros [[H _]|[[_ [_ H]]|[_ [H _]]]]; [lra|exact H|lra]]| |].
      + intros t I1 I2. rewrite E. apply Rmax_left. destruct (Rle_lt_dec t z) as [F|F].
        * rewrite (ramp_low T B) by lra. apply ramp_positive; assumption.
        * rewrite !ramp_line by lra. apply frac_le; [exact PT|nra].
      + intros t I1 I2. rewrite E. apply Rmax_right. destruct (Rle_lt_dec (t - z) T) as [F|F].
        * apply Rle_trans with (1 := ramp_under T A (t - q) PT PA ltac:(lra)). rewrite ramp_line by lra. apply frac_le; [exact PT|nra].
        * rewrite (ramp_full T B) by lra. apply Rle_trans with A; [exact (proj2 (ramp_positive T A (t - q) PT PA))|exact AB].
    - set (h := z + T * A / B). assert (Eh : B * (h - z) = T * A) by (unfold h; field; lra).
      assert (H1 : z <= h) by nra. assert (H2 : h <= z + T) by nra. assert (H3 : q + T <= h) by nra.
      rewrite (joined A q h z T B B g PA); try lra;
        [split; [intros; right; right; repeat split; assumption|intros [[H _]|[[_ [H _]]|[_ [_ H]]]]; [lra|lra|exact H]]| |].
      + intros t I1 I2. rewrite E. apply Rmax_left. destruct (Rle_lt_dec t z) as [F|F].
        * rewrite (ramp_low T B) by lra. apply ramp_positive; assumption.
        * rewrite (ramp_line T B) by lra. destruct (Rle_lt_dec (t - q) T) as [G|G].
          -- rewrite ramp_line by lra. apply frac_le; [exact PT|]. nra.
          -- rewrite ramp_full by lra. apply Rle_trans with (A * T / T); [apply frac_le; [exact PT|nra]|right; field; lra].
      + intros t I1 I2. rewrite E. apply Rmax_right. apply Rle_trans with A; [exact (proj2 (ramp_positive T A (t - q) PT PA))|].
        destruct (Rle_lt_dec (t - z) T) as [F|F]; [|rewrite ramp_full by lra; exact AB].
        rewrite ramp_line by lra. apply Rle_trans with (A * T / T); [right; field; lra|apply frac_le; [exact PT|nra]].
  Qed.

  Lemma together_right g : k = together -> (over x u g <-> aided k (v - u) g q z T A B).
  Proof.
    intros K. rewrite K. unfold aided.
    assert (E : forall t, assisted W k (Some q) z t = Rmin B (own t + by_aeb z t)) by (intros; rewrite K; reflexivity).
    assert (PB : 0 < B) by lra. set (m := (A * q + B * z) / (A + B)).
    assert (Em : (A + B) * m = A * q + B * z) by (unfold m; field; lra).
    set (n := z - T * A / B). assert (En : B * n = B * z - T * A) by (unfold n; field; lra).
    set (T' := T * B / (A + B)). assert (ET : T' * (A + B) = T * B) by (unfold T'; field; lra).
    assert (PT' : 0 < T') by (unfold T'; apply Rdiv_lt_0_compat; [apply Rmult_lt_0_compat|]; lra).
    assert (alone_own : forall t, t <= z -> Rmin B (own t + by_aeb z t) = own t).
    { intros t F. rewrite (ramp_low T B) by lra. pose proof (ramp_positive T A (t - q) PT PA). rewrite Rmin_right; lra. }
    assert (alone_aeb : forall t, t <= q -> Rmin B (own t + by_aeb z t) = by_aeb z t).
    { intros t F. rewrite (ramp_low T A) by lra. pose proof (ramp_positive T B (t - z) PT PB). rewrite Rmin_right; lra. }
    (* both grow, up to B *)
    assert (sum : forall t, q <= t -> z <= t -> t - q <= T -> t - z <= T -> own t + by_aeb z t = (A + B) * (t - m) / T).
    { intros t F1 F2 F3 F4. rewrite !ramp_line by lra.
      replace ((A + B) * (t - m)) with (A * (t - q) + B * (t - z)) by lra. field. lra. }
    assert (both : forall t, q <= t -> z <= t -> (t - q <= T \/ B * (z - q) <= T * A) -> (q <= z \/ t - q <= t - z) ->
      (t - m <= T' -> t - q <= T /\ t - z <= T) -> Rmin B (own t + by_aeb z t) = ramp T' B (t - m)).
    { intros t F1 F2 F3 F4 F5. assert (Pm : 0 <= t - m) by nra.
      destruct (Rle_lt_dec (t - m) T') as [G|G].
      - destruct (F5 G) as [G1 G2]. rewrite (sum t F1 F2 G1 G2). rewrite ramp_line by lra.
        assert (Q : (A + B) * (t - m) / T = B * (t - m) / T') by (unfold T'; field; lra). rewrite Q. apply Rmin_right.
        apply Rle_trans with (B * T' / T'); [apply frac_le; [exact PT'|nra]|right; field; lra].
      - rewrite (ramp_full T' B) by lra. apply Rmin_left.
        pose proof (ramp_positive T A (t - q) PT PA) as O. pose proof (ramp_positive T B (t - z) PT PB) as O2.
        destruct (Rle_lt_dec T (t - z)) as [H|H]; [rewrite (ramp_full T B) by lra; lra|].
        destruct (Rle_lt_dec (t - q) T) as [I|I].
        + rewrite (sum t F1 F2 I ltac:(lra)). apply Rle_trans with (T * B / T); [right; field; lra|]. apply frac_le; [exact PT|].
          rewrite <- ET. assert (T' * (A + B) <= (t - m) * (A + B)) by (apply Rmult_le_compat_r; lra). lra.
        + rewrite (ramp_full T A) by lra. rewrite (ramp_line T B) by lra.
          replace (A + B * (t - z) / T) with ((T * A + B * (t - z)) / T) by (field; lra).
          apply Rle_trans with (T * B / T); [right; field; lra|]. apply frac_le; [exact PT|]. destruct F3 as [F3|F3]; [lra|]. nra. }
    (* the driver's braking is full *)
    assert (rest : forall t, q + T <= t -> z <= t -> Rmin B (own t + by_aeb z t) = ramp T B (t - n)).
    { intros t F1 F2. rewrite (ramp_full T A) by lra. assert (Pn : 0 <= t - n) by nra.
      destruct (Rle_lt_dec (t - n) T) as [G|G].
      - assert (G' : t - z <= T) by nra. rewrite !ramp_line by lra.
        assert (Q : A + B * (t - z) / T = B * (t - n) / T).
        { replace (B * (t - n)) with (B * (t - z) + T * A) by lra. field. lra. }
        rewrite Q. apply Rmin_right. apply Rle_trans with (B * T / T); [apply frac_le; [exact PT|nra]|right; field; lra].
      - rewrite (ramp_full T B (t - n)) by lra. apply Rmin_left. destruct (Rle_lt_dec T (t - z)) as [H|H].
        + rewrite (ramp_full T B) by lra. lra.
        + rewrite (ramp_line T B) by lra. replace (A + B * (t - z) / T) with (B * (t - n) / T)
            by (replace (B * (t - n)) with (B * (t - z) + T * A) by lra; field; lra).
          apply Rle_trans with (B * T / T); [right; field; lra|apply frac_le; [exact PT|nra]]. }
    assert (late : q + T <= z -> (over x u g <-> gainsOver (v - u) g q z n 1 T A B B)).
    { intros O. assert (Pn : q <= n) by nra.
      apply (joined A q z n T B B g PA); try lra; try nra.
      - intros t H1 H2. rewrite E. apply alone_own. lra.
      - intros t H1 H2. rewrite E. apply rest; lra. }
    destruct (Rle_lt_dec z q) as [M|M].
    - destruct (Rle_lt_dec (z + T) q) as [N|N].
      + rewrite (alone B z g PB Hz);
          [split; [intros; left; split; assumption
                  |intros [[_ H]|[[_ [H _]]|[[H _]|[[H _]|[H _]]]]]; [exact H|lra|lra|nra|lra]]|].
        intros t H1 H2. rewrite E. destruct (Rle_lt_dec t q) as [F|F]; [apply alone_aeb; exact F|].
        rewrite (ramp_full T B) by lra. pose proof (ramp_positive T A (t - q) PT PA). apply Rmin_left. lra.
      + rewrite (joined B z q m T' (A + B) B g PB); try lra; try nra;
          [split; [intros; right; left; repeat split; assumption
                  |intros [[H _]|[[_ [_ H]]|[[H _]|[[H _]|[H _]]]]]; [lra|exact H|lra|nra|lra]]| |].
        * intros t H1 H2. rewrite E. apply alone_aeb. lra.
        * intros t H1 H2. rewrite E. apply both; try lra; try (right; nra). intros G.
          assert (T' * (A + B) >= (t - m) * (A + B)) by (apply Rle_ge, Rmult_le_compat_r; lra). split; nra.
    - destruct (Rle_lt_dec (B * (z - q)) (T * A)) as [N|N]; [|destruct (Rle_lt_dec (q + T) z) as [O|O]].
      + assert (Q : z - q <= T) by nra.
        assert (R : over x u g <-> gainsOver (v - u) g q z m 1 T A (A + B) B).
        { apply (joined A q z m T' (A + B) B g PA); try lra; try nra.
          - intros t H1 H2. rewrite E. apply alone_own. lra.
          - intros t H1 H2. rewrite E. apply both; try lra; try (right; exact N). intros G.
            assert (T' * (A + B) >= (t - m) * (A + B)) by (apply Rle_ge, Rmult_le_compat_r; lra). split; nra. }
        split; [intros H; apply R in H; right; right; left; repeat split; assumption|].
        intros [[H _]|[[H _]|[[_ [_ H]]|[[H _]|[H F]]]]]; [lra|lra|apply R; exact H|lra|apply (late H); exact F].
      + rewrite (late O). split; [intros; right; right; right; right; split; assumption|].
        intros [[H _]|[[H _]|[[_ [H _]]|[[_ [H _]]|[_ H]]]]]; [lra|lra|lra|lra|exact H].
      + assert (Pn : q <= n) by nra.
        destruct (brakes_exists v q T A ltac:(lra) Hq ltac:(lra) PA) as [X1 B1].
        assert (R : over x u g <-> gainsAdded (v - u) g q z m 1 T A B).
        { unfold gainsAdded. replace (z - 1 * T * A / B) with n by (unfold n; field; lra). replace (q + 1 * T) with (q + T) by ring.
          apply (three v u L x Hu X0 X L_grows q z (q + T) T A B (v - L z + lost T (A + B) (z - m))
            (v - L (q + T) + lost T B (q + T - n)) m n T X1 g); try assumption; try lra; try nra.
          - apply from_0; [lra|exact PT|lra|]. intros t H1 H2. rewrite E. apply alone_own. lra.
          - apply piece_but; [lra|exact PT|]. intros t H1 H2. rewrite E. rewrite (sum t) by lra.
            assert (S1 : (A + B) * (t - m) <= B * T) by nra. assert (S2 : t - m <= T) by nra. assert (S3 : 0 <= t - m) by nra.
            rewrite ramp_line by lra. apply Rmin_right.
            apply Rle_trans with (B * T / T); [apply frac_le; [exact PT|exact S1]|right; field; lra].
          - apply from_on; [lra|exact PT|]. intros t H1 H2. rewrite E. apply rest; lra. }
        rewrite R. split; [intros; right; right; right; left; repeat split; assumption|].
        intros [[H _]|[[H _]|[[_ [H _]]|[[_ [_ H]]|[H _]]]]]; [lra|lra|lra|exact H|lra].
  Qed.
  Lemma assisted_right g : over x u g <-> aided k (v - u) g q z T A B.
  Proof.
    assert (K : k = in_place \/ k = greater \/ k = together) by (clear D; destruct k; tauto).
    destruct K as [K|[K|K]]; [apply in_place_right|apply greater_right|apply together_right]; exact K.
  Qed.
End With.

(* --- there is such a motion --------------------------------------------------------------------------------- *)
Lemma ramp_continuous T A m t : 0 < T -> continuity_pt (fun t => ramp T A (t - m)) t.
Proof.
  intros P. apply (continuous_ext (fun t => A / T * (Rmax 0 (t - m) - Rmax 0 (t - (m + T))))).
  - intros y. destruct (ramp_is T A (y - m) P) as [[L E]|[[L E]|[L E]]]; rewrite E.
    + rewrite !Rmax_left by lra. ring.
    + rewrite (Rmax_right 0 (y - m)), (Rmax_left 0 (y - (m + T))) by lra. field. lra.
    + rewrite !Rmax_right by lra. field. lra.
  - assert (K : forall c, continuity_pt (fun t => Rmax 0 (t - c)) t).
    { intros c. apply max_continuous, derivable_continuous_pt. eexists.
      apply (derivable_pt_lim_minus id (fun _ => c)); [apply derivable_pt_lim_id|apply derivable_pt_lim_const]. }
    apply (continuity_pt_scal (fun t => Rmax 0 (t - m) - Rmax 0 (t - (m + T))) (A / T)).
    apply (continuity_pt_minus (fun t => Rmax 0 (t - m)) (fun t => Rmax 0 (t - (m + T)))); apply K.
Qed.

Section Exists.
  Variables (W : world).
  Notation T := (parameter W "cc_ramp").
  Notation A := (parameter W "cc_braking").
  Notation B := (parameter W "aeb_braking").
  Hypotheses (PT : 0 < T) (PA : 0 < A) (AB : A <= B).
  Variables (k : aeb) (v q z : R).
  Hypotheses (Hv : 0 <= v) (Hq : 0 <= q) (Hz : 0 <= z).
  Notation own t := (ramp T A (t - q)).
  Notation by_aeb m t := (ramp T B (t - m)).
  Let far := q + z + T.

  (* from a braking that is continuous, and B at last *)
  Lemma made (braking : R -> R) : (forall t, 0 <= t -> continuity_pt braking t) -> (forall t, far <= t -> braking t = B) ->
    exists x, goes v braking (z :: nil) x.
  Proof.
    intros C F. assert (P : 0 <= far) by (unfold far; lra).
    destruct (primitive_exists braking far P C) as [L [L0 D]]; [intros t Ht; rewrite !F by lra; reflexivity|].
    assert (E : forall t, far <= t -> L t = L far + B * (t - far)).
    { intros t Ht. rewrite (gains_cubic L braking far t far B 0 0); [ring|exact Ht| | |].
      - intros y Hy. apply derivable_continuous_pt. eexists. apply D. lra.
      - intros y Hy. apply D. lra.
      - intros y Hy. rewrite F by lra. ring. }
    set (last := far + Rabs (v - L far) / B). assert (PB : 0 < B) by lra.
    assert (P2 : 0 <= Rabs (v - L far) / B) by (apply Rmult_le_pos; [apply Rabs_pos|left; apply Rinv_0_lt_compat; exact PB]).
    assert (Q : B * (Rabs (v - L far) / B) = Rabs (v - L far)) by (field; lra). pose proof (Rle_abs (v - L far)).
    apply (goes_exists v braking (z :: nil) L last); [exact L0| |intros; apply D; lra|unfold last; lra|].
    - intros t Ht. apply derivable_continuous_pt. eexists. apply D. exact Ht.
    - intros t Ht. rewrite (E t), (E last) by (unfold last in *; lra).
      assert (B * (Rabs (v - L far) / B) <= B * (t - far)) by (apply Rmult_le_compat_l; unfold last in Ht; lra).
      rewrite !Rmax_left; [reflexivity| |]; unfold last; lra.
  Qed.
  Lemma assisted_exists : exists x, goes v (assisted W k (Some q) z) (z :: nil) x.
  Proof.
    destruct k.
    - (* in place: speed taken in closed form *)
      set (m := Rmin q z). assert (Hm : 0 <= m) by (apply Rmin_glb; assumption). assert (mz : m <= z) by apply Rmin_r.
      assert (PB : 0 < B) by lra.
      assert (G : forall t, Rmin t z = z - Rmax 0 (z - t))
        by (intros t; unfold Rmin, Rmax; destruct (Rle_dec t z), (Rle_dec 0 (z - t)); lra).
      assert (G2 : forall t, Rmax t z = z + Rmax 0 (t - z)) by (intros t; unfold Rmax; destruct (Rle_dec t z), (Rle_dec 0 (t - z)); lra).
      assert (lin : forall c t, continuity_pt (fun t => Rmax 0 (t - c)) t).
      { intros c t. apply max_continuous, derivable_continuous_pt. eexists.
        apply (derivable_pt_lim_minus id (fun _ => c)); [apply derivable_pt_lim_id|apply derivable_pt_lim_const]. }
      assert (rin : forall c t, continuity_pt (fun t => Rmax 0 (c - t)) t).
      { intros c t. apply max_continuous, derivable_continuous_pt. eexists.
        apply (derivable_pt_lim_minus (fun _ => c) id); [apply derivable_pt_lim_const|apply derivable_pt_lim_id]. }
      assert (lost_continuous : forall A' s, continuity_pt (lost T A') s).
      { intros A' s. apply derivable_continuous_pt. eexists. apply lost_slope. exact PT. }
      set (L := fun t => lost T A (Rmin t z - q) + (lost T B (Rmax t z - m) - lost T B (z - m))).
      apply (goes_exists v _ (z :: nil) L (z + T + v / B)).
      + unfold L. rewrite Rmin_left, Rmax_right by lra. rewrite lost_before by lra. ring.
      + intros t _. unfold L.
        apply (continuity_pt_plus (fun t => lost T A (Rmin t z - q)) (fun t => lost T B (Rmax t z - m) - lost T B (z - m))).
        * apply (continuous_ext (fun t => lost T A (z - q - Rmax 0 (z - t)))); [intros s; rewrite G; f_equal; ring|].
          apply (continuity_pt_comp (fun t => z - q - Rmax 0 (z - t)) (lost T A)); [|apply lost_continuous].
          apply (continuity_pt_minus (fun _ => z - q) (fun t => Rmax 0 (z - t))); [|apply rin].
          apply derivable_continuous_pt, derivable_pt_const.
        * apply (continuity_pt_minus (fun t => lost T B (Rmax t z - m)) (fun _ => lost T B (z - m)));
            [|apply derivable_continuous_pt, derivable_pt_const].
          apply (continuous_ext (fun t => lost T B (z - m + Rmax 0 (t - z)))); [intros s; rewrite G2; f_equal; ring|].
          apply (continuity_pt_comp (fun t => z - m + Rmax 0 (t - z)) (lost T B)); [|apply lost_continuous].
          apply (continuity_pt_plus (fun _ => z - m) (fun t => Rmax 0 (t - z))); [|apply lin].
          apply derivable_continuous_pt, derivable_pt_const.
      + intros t Ht N. assert (N' : t <> z) by (intros ->; apply N; left; reflexivity).
        unfold assisted, Prescribed.par. fold m. destruct (Rlt_dec t z) as [F|F].
        * apply (derivable_pt_lim_locally_ext (fun t => lost T A (t - q)) _ t (t - 1) z); [lra| |apply shift, lost_slope; exact PT].
          intros y Hy. unfold L. rewrite Rmin_left, Rmax_right by lra. ring.
        * apply (derivable_pt_lim_locally_ext (fun t => lost T A (z - q) - lost T B (z - m) + lost T B (t - m)) _ t z (t + 1)); [lra| |].
          -- intros y Hy. unfold L. rewrite Rmin_right, Rmax_left by lra. ring.
          -- replace (by_aeb m t) with (0 + by_aeb m t) by ring.
             apply (derivable_pt_lim_plus (fun _ => lost T A (z - q) - lost T B (z - m)) (fun t => lost T B (t - m)));
               [apply derivable_pt_lim_const|apply shift, lost_slope; exact PT].
      + assert (0 <= v / B) by (apply Rmult_le_pos; [exact Hv|left; apply Rinv_0_lt_compat; exact PB]). lra.
      + assert (Be : B * (v / B) = v) by (field; lra). set (e := v / B) in *. assert (0 <= e) by nra.
        intros t Ht. unfold L. rewrite (Rmin_right t z), (Rmin_right (z + T + e) z), (Rmax_left t z), (Rmax_left (z + T + e) z) by lra.
        pose proof (lost_positive T A PA (z - q)) as O.
        assert (far_enough : forall y, z + T + e <= y -> v <= lost T B (y - m) - lost T B (z - m)).
        { intros y Hy. rewrite (lost_full T B (Rlt_le _ _ PT) (y - m)) by lra.
          destruct (Rle_lt_dec (z - m) T) as [K|K].
          - rewrite lost_ramp by lra. assert (B * (z - m) ^ 2 / (2 * T) <= B * (z - m) / 2); [|nra].
            apply Rmult_le_reg_r with (2 * T); [lra|].
            replace (B * (z - m) ^ 2 / (2 * T) * (2 * T)) with (B * (z - m) * (z - m)) by (field; lra).
            replace (B * (z - m) / 2 * (2 * T)) with (B * (z - m) * T) by field.
            apply Rmult_le_compat_l; [apply Rmult_le_pos; lra|exact K].
          - rewrite (lost_full T B (Rlt_le _ _ PT) (z - m)) by lra. nra. }
        pose proof (far_enough t Ht). pose proof (far_enough (z + T + e) (Rle_refl _)).
        rewrite !Rmax_left by lra. reflexivity.
    - apply made.
      + intros t _. unfold assisted, Prescribed.par.
        apply (continuous_ext (fun t => by_aeb z t + Rmax 0 (own t - by_aeb z t))).
        * intros y. unfold Rmax. destruct (Rle_dec 0 (own y - by_aeb z y)), (Rle_dec (own y) (by_aeb z y)); lra.
        * apply (continuity_pt_plus (fun t => by_aeb z t) (fun t => Rmax 0 (own t - by_aeb z t))); [apply ramp_continuous; exact PT|].
          apply (max_continuous (fun t => own t - by_aeb z t)).
          apply (continuity_pt_minus (fun t => own t) (fun t => by_aeb z t)); apply ramp_continuous; exact PT.
      + intros t Ht. unfold assisted, Prescribed.par, far in *. rewrite !ramp_full by lra. apply Rmax_right. exact AB.
    - apply made.
      + intros t _. unfold assisted, Prescribed.par.
        apply (continuous_ext (fun t => B - Rmax 0 (B - (own t + by_aeb z t)))).
        * intros y. unfold Rmax, Rmin. destruct (Rle_dec 0 (B - (own y + by_aeb z y))), (Rle_dec B (own y + by_aeb z y)); lra.
        * apply (continuity_pt_minus (fun _ => B) (fun t => Rmax 0 (B - (own t + by_aeb z t))));
            [apply derivable_continuous_pt, derivable_pt_const|].
          apply (max_continuous (fun t => B - (own t + by_aeb z t))).
          apply (continuity_pt_minus (fun _ => B) (fun t => own t + by_aeb z t)); [apply derivable_continuous_pt, derivable_pt_const|].
          apply (continuity_pt_plus (fun t => own t) (fun t => by_aeb z t)); apply ramp_continuous; exact PT.
      + intros t Ht. unfold assisted, Prescribed.par, far in *. rewrite !ramp_full by lra. apply Rmin_left. lra.
  Qed.
End Exists.
