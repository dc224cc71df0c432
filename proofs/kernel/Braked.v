(* What a vehicle that brakes gains on one that brakes, too, until it stands.  NOT TRUSTED: proved.

   The definitions are those of driver.spec, over numbers.  `ever_braking` says that they tell whether it gains more
   than g at some time: where it does, it does when both stand, or at an instant of equal speeds. *)
From Coq Require Import Reals List Lra Psatz.
From Roadproof Require Import Prescribed Braking Gained.
Import ListNotations.
Open Scope R_scope.

Definition standsLater v w b g q T A : Prop :=
  (A * T <= 2 * v /\ A * (24 * b * (g - v * q) + 12 * w ^ 2) < b * (12 * A * v * T + 12 * v ^ 2 - A ^ 2 * T ^ 2))
  \/ (2 * v < A * T /\ 3 * (2 * b * (g - v * q) + w ^ 2) < 4 * T * b * v
      /\ (2 * b * (g - v * q) + w ^ 2 < 0 \/ 9 * A * (2 * b * (g - v * q) + w ^ 2) ^ 2 < 32 * T * b ^ 2 * v ^ 3)).
Definition meetsInFull v w b g q T A : Prop :=
  b < A /\ (A - b) * (q + T) <= v - w + A * (q + T / 2) /\ b * (v - w + A * (q + T / 2)) <= w * (A - b)
  /\ 24 * (A - b) * g < 12 * (v - w + A * (q + T / 2)) ^ 2 - (A - b) * (12 * A * (q + T / 2) ^ 2 + A * T ^ 2).
Definition gainsSome e b g T : Prop := 6 * g < T * (4 * e + b * T) \/ (e < 0 /\ 6 * g < b * T ^ 2).
Definition gainsInRamp e b g T A : Prop :=
  3 * A ^ 2 * g < 3 * A * T * b * e + T ^ 2 * b ^ 3
  \/ 9 * A ^ 2 * g ^ 2 - (18 * A * T * b * e + 6 * T ^ 2 * b ^ 3) * g - 3 * T ^ 2 * b ^ 2 * e ^ 2 - 8 * A * T * e ^ 3 < 0.
Definition meetsInRamp v w b g q T A : Prop :=
  b <= A /\ 2 * (v - w + b * (q + T)) <= A * T /\ T * b ^ 2 <= A * (w - b * q)
  /\ (b * (q + T) <= w \/ 2 * T * b ^ 2 * v <= A * (w - b * q) ^ 2) /\ 0 <= T * b ^ 2 + 2 * A * (v - w + b * q)
  /\ gainsSome (v - w + b * q) b (g - (v - w) * q - b * q ^ 2 / 2) T
  /\ gainsInRamp (v - w + b * q) b (g - (v - w) * q - b * q ^ 2 / 2) T A.
Definition gainsBraking v w b g q T A : Prop :=
  standsLater v w b g q T A \/ meetsInFull v w b g q T A \/ meetsInRamp v w b g q T A.

(* --- the instant of equal speeds in the ramp: s seconds after it began --- *)
Section Ramp.
  Variables e b T A s : R.
  Hypotheses (PT : 0 < T) (PA : 0 < A) (Pb : 0 < b) (Hs : b * T <= A * s) (Es : A * s ^ 2 = 2 * T * (b * s + e)).
  Let greatest := 2 / 3 * e * s + b * s ^ 2 / 6.
  (* the other root, and what is gained there *)
  Let s' := 2 * b * T / A - s.
  Let least := 2 / 3 * e * s' + b * s' ^ 2 / 6.

  Lemma e_is : e = A * s ^ 2 / (2 * T) - b * s.
  Proof. rewrite Es. field. lra. Qed.
  Lemma middle : 3 * A ^ 2 * ((greatest + least) / 2) = 3 * A * T * b * e + T ^ 2 * b ^ 3.
  Proof. unfold greatest, least, s'. rewrite e_is. field. lra. Qed.
  Lemma apart : greatest - least = 2 * T ^ 2 / (3 * A ^ 2) * (A * s / T - b) ^ 3.
  Proof. unfold greatest, least, s'. rewrite e_is. field. lra. Qed.
  Lemma quadratic g :
    9 * A ^ 2 * g ^ 2 - (18 * A * T * b * e + 6 * T ^ 2 * b ^ 3) * g - 3 * T ^ 2 * b ^ 2 * e ^ 2 - 8 * A * T * e ^ 3
    = 9 * A ^ 2 * ((g - greatest) * (g - least)).
  Proof. unfold greatest, least, s'. rewrite e_is. field. lra. Qed.

  Lemma least_least : least <= greatest.
  Proof.
    pose proof apart. assert (0 <= 2 * T ^ 2 / (3 * A ^ 2) * (A * s / T - b) ^ 3); [|lra].
    assert (b <= A * s / T). { apply Rmult_le_reg_r with T; [exact PT|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. }
    apply Rmult_le_pos; [|apply pow_le; lra]. apply Rmult_le_pos; [nra|]. left. apply Rinv_0_lt_compat. nra.
  Qed.
  Lemma in_ramp_right g : gainsInRamp e b g T A <-> g < greatest.
  Proof.
    unfold gainsInRamp. rewrite quadratic, <- middle. pose proof least_least. assert (P2 : 0 < A ^ 2) by (apply pow_lt; lra).
    split.
    - intros [H'|H'].
      + assert (g < (greatest + least) / 2); [|lra]. apply Rmult_lt_reg_l with (3 * A ^ 2); lra.
      + apply Rnot_le_lt. intros N. assert (0 <= (g - greatest) * (g - least)) by (apply Rmult_le_pos; lra).
        assert (0 <= 9 * A ^ 2 * ((g - greatest) * (g - least))) by (apply Rmult_le_pos; lra). lra.
    - intros H'. destruct (Rlt_le_dec g ((greatest + least) / 2)) as [L|L].
      + left. apply Rmult_lt_compat_l; lra.
      + right. assert (0 < (greatest - g) * (g - least)) by (apply Rmult_lt_0_compat; lra).
        assert (0 < 9 * A ^ 2 * ((greatest - g) * (g - least))) by (apply Rmult_lt_0_compat; lra). lra.
  Qed.
  Lemma some_right g : 0 <= s <= T -> g < greatest -> gainsSome e b g T.
  Proof.
    intros S G. unfold gainsSome. unfold greatest in G. assert (s ^ 2 <= T ^ 2) by (apply pow_incr; lra).
    assert (b * s ^ 2 <= b * T ^ 2) by (apply Rmult_le_compat_l; lra).
    destruct (Rlt_le_dec e 0) as [N|N]; [right; split; [exact N|nra]|left; nra].
  Qed.
  Lemma greatest_is : e * s + b * s ^ 2 / 2 - A * s ^ 3 / (6 * T) = greatest.
  Proof. unfold greatest. rewrite e_is. field. lra. Qed.
End Ramp.

Section Both.
  Variables v w b g q T A : R.
  Hypotheses (Hv : 0 <= v) (Hw : 0 <= w) (Hb : 0 < b) (Hg : 0 <= g) (Hq : 0 <= q) (HT : 0 <= T) (HA : 0 < A).
  Variables x p : R -> R.
  Hypotheses (X0 : x 0 = 0) (P0 : p 0 = 0).
  Hypothesis X : forall t, 0 <= t -> derivable_pt_lim x t (speed_at v q T A t).
  Hypothesis P : forall t, 0 <= t -> derivable_pt_lim p t (speed_at w 0 0 b t).
  Definition D t := x t - p t.
  Definition slope t := speed_at v q T A t - speed_at w 0 0 b t.

  Lemma D_slope t : 0 <= t -> derivable_pt_lim D t (slope t).
  Proof. intros H. apply derivable_pt_lim_minus; [apply X|apply P]; exact H. Qed.
  Lemma p_speed t : 0 <= t -> b * t <= w -> speed_at w 0 0 b t = w - b * t.
  Proof. intros H M. unfold speed_at. rewrite lost_full by lra. rewrite Rmax_right by lra. field. Qed.
  Lemma p_no_speed t : 0 <= t -> w <= b * t -> speed_at w 0 0 b t = 0.
  Proof. intros H M. unfold speed_at. rewrite lost_full by lra. apply Rmax_left. lra. Qed.
  Lemma p_moves t : 0 <= t -> b * t <= w -> p t = w * t - b * t ^ 2 / 2.
  Proof. intros H M. rewrite (x_full w 0 0 b Hw (Rle_refl 0) (Rle_refl 0) Hb p P0 P t) by lra. field. Qed.
  Lemma p_stands t : w <= b * t -> p t = w ^ 2 / (2 * b).
  Proof. intros M. rewrite (x_stands w 0 0 b Hw (Rle_refl 0) (Rle_refl 0) Hb p P0 P t) by lra. field. lra. Qed.

  Lemma stands_right t : w <= b * t -> q + T + v / A <= t -> (standsLater v w b g q T A <-> g < D t).
  Proof.
    intros M N. unfold D, standsLater. rewrite p_stands by exact M.
    assert (Ae : A * (v / A) = v) by (field; lra). set (z := v / A) in *. assert (Z : 0 <= z) by nra.
    assert (Wb : 2 * b * (w ^ 2 / (2 * b)) = w ^ 2) by (field; lra).
    assert (S : A * T <= 2 * v -> x t = v * q + v * T / 2 + v ^ 2 / (2 * A) - A * T ^ 2 / 24).
    { intros L. apply (x_stands v q T A Hv Hq HT HA x X0 X t); [lra|nra]. }
    assert (S' : 24 * A * (v * q + v * T / 2 + v ^ 2 / (2 * A) - A * T ^ 2 / 24)
      = 24 * A * (v * q) + (12 * A * v * T + 12 * v ^ 2 - A ^ 2 * T ^ 2)) by (field; lra).
    assert (E : 2 * v < A * T -> x t = v * q + 2 / 3 * v * sqrt (2 * T * v / A)).
    { intros L. apply (x_stands_early v q T A Hv Hq HT HA x X0 X t); [exact L|lra|].
      assert (T ^ 2 <= (t - q) ^ 2) by (apply pow_incr; lra).
      assert (A * T ^ 2 <= A * (t - q) ^ 2) by (apply Rmult_le_compat_l; lra). nra. }
    destruct (Rlt_le_dec (2 * v) (A * T)) as [L|L].
    - rewrite (E L). set (r := sqrt (2 * T * v / A)) in *.
      set (z' := 2 * b * (g - v * q) + w ^ 2).
      assert (R : g < v * q + 2 / 3 * v * r - w ^ 2 / (2 * b) <-> z' / (2 * b) < 2 / 3 * v * r).
      { unfold z'. replace ((2 * b * (g - v * q) + w ^ 2) / (2 * b)) with (g - v * q + w ^ 2 / (2 * b)) by (field; lra). split; lra. }
      rewrite R. unfold r. rewrite (below_root A v T (z' / (2 * b)) HA Hv HT).
      assert (R1 : z' / (2 * b) < 0 <-> z' < 0).
      { symmetry. apply (scaled_lt (2 * b)); [lra|field; lra|ring]. }
      assert (R2 : 9 * A * (z' / (2 * b)) ^ 2 < 8 * T * v ^ 3 <-> 9 * A * z' ^ 2 < 32 * T * b ^ 2 * v ^ 3).
      { symmetry. apply (scaled_lt (4 * b ^ 2)); [nra|field; lra|ring]. }
      rewrite R1, R2. split; [intros [[N' _]|[_ [_ H]]]; [lra|exact H]|]. intros H. right. split; [exact L|]. split; [|exact H].
      assert (Q : z' / (2 * b) < 2 / 3 * v * r) by (apply (below_root A v T _ HA Hv HT); rewrite R1, R2; exact H).
      assert (PT : 0 < T) by nra.
      assert (Ar : A * r ^ 2 = 2 * T * v) by (apply root_of; [lra|nra]).
      assert (R3 : r <= T) by (apply (below A); [lra|lra|nra]).
      apply (Rmult_lt_compat_l (6 * b)) in Q; [|lra]. replace (6 * b * (z' / (2 * b))) with (3 * z') in Q by (field; lra).
      assert (v * r <= v * T) by (apply Rmult_le_compat_l; lra).
      assert (b * (v * r) <= b * (v * T)) by (apply Rmult_le_compat_l; lra). lra.
    - rewrite (S L). assert (R : g < v * q + v * T / 2 + v ^ 2 / (2 * A) - A * T ^ 2 / 24 - w ^ 2 / (2 * b)
        <-> A * (24 * b * (g - v * q) + 12 * w ^ 2) < b * (12 * A * v * T + 12 * v ^ 2 - A ^ 2 * T ^ 2)).
      { symmetry.
        transitivity (24 * A * b * (g - v * q + w ^ 2 / (2 * b)) < 24 * A * b * (v * T / 2 + v ^ 2 / (2 * A) - A * T ^ 2 / 24)).
        - replace (24 * A * b * (g - v * q + w ^ 2 / (2 * b))) with (A * (24 * b * (g - v * q) + 12 * w ^ 2)) by (field; lra).
          replace (24 * A * b * (v * T / 2 + v ^ 2 / (2 * A) - A * T ^ 2 / 24))
            with (b * (12 * A * v * T + 12 * v ^ 2 - A ^ 2 * T ^ 2)) by (field; lra). reflexivity.
        - assert (K : 0 < 24 * A * b) by nra. rewrite (scaled_lt (24 * A * b) _ _ _ _ K eq_refl eq_refl). split; lra. }
      rewrite R. split; [intros [[_ H]|[N' _]]; [exact H|lra]|]. intros H. left. split; assumption.
  Qed.

  (* speeds are equal at t, while both move: so they are after this *)
  Definition gap_of t := v - lost T A (t - q) - (w - b * t).
  Lemma slope_is t : 0 <= t -> b * t <= w -> lost T A (t - q) <= v -> slope t = gap_of t.
  Proof. intros H M N. unfold slope, gap_of. rewrite p_speed by assumption. unfold speed_at. rewrite Rmax_right; lra. Qed.

  Lemma full_reached t : q + T <= t -> 0 <= w - b * t -> (A - b) * t = v - w + A * (q + T / 2) ->
    D t = (A - b) * t ^ 2 / 2 - A * (q + T / 2) ^ 2 / 2 - A * T ^ 2 / 24.
  Proof.
    intros L M E. unfold D. rewrite p_moves by lra.
    assert (V : v - A * (t - q - T / 2) = w - b * t) by lra.
    assert (F : A * T <= 2 * v) by nra.
    rewrite (x_full v q T A Hv Hq HT HA x X0 X t) by lra.
    replace v with (w - b * t + A * (t - q - T / 2)) at 1 by lra. field.
  Qed.
  Lemma ramp_reached s : 0 < T -> 0 <= s <= T -> 0 <= w - b * (q + s) -> A * s ^ 2 = 2 * T * (b * s + (v - w + b * q)) ->
    D (q + s) = (v - w) * q + b * q ^ 2 / 2 + (2 / 3 * (v - w + b * q) * s + b * s ^ 2 / 6).
  Proof.
    intros PT S M E. unfold D. rewrite p_moves by lra.
    assert (R : q + s - q = s) by ring.
    rewrite (x_ramp v q T A Hv Hq HA x X0 X (q + s) PT ltac:(lra)) by (rewrite R, E; nra). rewrite R.
    rewrite <- (greatest_is (v - w + b * q) b T A s PT E). field. lra.
  Qed.

  Lemma gains_then : gainsBraking v w b g q T A -> exists t, 0 <= t /\ D t > g.
  Proof.
    intros [H|[H|H]].
    - set (t := Rmax (w / b) (q + T + v / A)).
      assert (Q1 : w / b <= t) by apply Rmax_l. assert (Q2 : q + T + v / A <= t) by apply Rmax_r.
      assert (0 <= v / A) by (apply Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]).
      assert (Wb : b * (w / b) = w) by (field; lra).
      exists t. split; [lra|]. apply (stands_right t); [nra|exact Q2|exact H].
    - destruct H as [L [F [M G]]]. set (t := (v - w + A * (q + T / 2)) / (A - b)).
      assert (E : (A - b) * t = v - w + A * (q + T / 2)) by (unfold t; field; lra).
      assert (T1 : q + T <= t) by nra. assert (T2 : 0 <= w - b * t).
      { apply Rmult_le_reg_l with (A - b); [lra|]. rewrite <- E in M. lra. }
      exists t. split; [lra|]. rewrite (full_reached t T1 T2 E). rewrite <- E in G.
      apply Rmult_lt_reg_l with (24 * (A - b)); [lra|].
      assert (Z : 24 * (A - b) * ((A - b) * t ^ 2 / 2 - A * (q + T / 2) ^ 2 / 2 - A * T ^ 2 / 24)
        = 12 * ((A - b) * t) ^ 2 - (A - b) * (12 * A * (q + T / 2) ^ 2 + A * T ^ 2)) by field. lra.
    - destruct H as [L [F [M [N [K [_ G]]]]]].
      set (e := v - w + b * q) in *. set (G' := g - (v - w) * q - b * q ^ 2 / 2) in *.
      destruct (Rle_lt_or_eq_dec 0 T HT) as [PT|Z].
      + assert (K' : 0 <= b ^ 2 + 2 * A * e / T).
        { replace (b ^ 2 + 2 * A * e / T) with ((T * b ^ 2 + 2 * A * e) / T) by (field; lra).
          apply Rmult_le_pos; [exact K|left; apply Rinv_0_lt_compat; lra]. }
        set (d := sqrt (b ^ 2 + 2 * A * e / T)). assert (D0 : 0 <= d) by apply sqrt_pos.
        assert (D2 : d * d = b ^ 2 + 2 * A * e / T) by (apply sqrt_sqrt; exact K').
        set (s := (b + d) * T / A).
        assert (As : A * s = (b + d) * T) by (unfold s; field; lra).
        assert (E : A * s ^ 2 = 2 * T * (b * s + e)).
        { assert (A * (A * s ^ 2) = A * (2 * T * (b * s + e))); [|nra].
          replace (A * (A * s ^ 2)) with ((A * s) ^ 2) by ring. 
          replace (A * (2 * T * (b * s + e))) with (2 * T * (b * (A * s)) + 2 * T * A * e) by ring. rewrite As.
          assert (D3 : T * (d * d) = T * b ^ 2 + 2 * A * e) by (rewrite D2; field; lra).
          replace (((b + d) * T) ^ 2) with (T ^ 2 * b ^ 2 + 2 * T ^ 2 * b * d + T * (T * (d * d))) by ring. rewrite D3. ring. }
        assert (S1 : b * T <= A * s) by (rewrite As; nra).
        assert (S0 : 0 <= s) by nra.
        assert (S2 : s <= T).
        { apply Rnot_lt_le. intros B. assert (A * T <= (b + d) * T) by nra.
          assert (Q : 0 < (s - T) * (A * (s + T) - 2 * T * b)). { apply Rmult_lt_0_compat; [lra|]. nra. }
          unfold e in *. nra. }
        assert (S3 : 0 <= w - b * (q + s)).
        { destruct N as [N|N]; [nra|].
          apply Rnot_lt_le. intros B. set (k := w - b * q) in *.
          assert (B' : 0 < b * s - k) by (unfold k; lra).
          assert (Q : 0 < (b * s - k) * (A * (b * s + k) - 2 * T * b ^ 2)). { apply Rmult_lt_0_compat; [lra|]. nra. }
          assert (V : v = e + k) by (unfold e, k; ring). rewrite V in N. nra. }
        exists (q + s). split; [lra|]. rewrite (ramp_reached s PT ltac:(lra) S3 E). fold e.
        apply (in_ramp_right e b T A s PT HA S1 E) in G. unfold G' in G. lra.
      + rewrite <- Z in *. assert (E1 : e <= 0) by (unfold e in *; lra).
        assert (E2 : 0 <= e) by (apply Rnot_lt_le; intros B; assert (0 < A * (- e)) by (apply Rmult_lt_0_compat; lra); lra).
        assert (E : e = 0) by lra.
        assert (A2 : 0 < A ^ 2) by (apply pow_lt; exact HA).
        assert (G0 : G' < 0).
        { rewrite E in G. destruct G as [G|G]; apply Rnot_le_lt; intros B.
          - assert (0 <= A ^ 2 * G') by (apply Rmult_le_pos; lra). lra.
          - assert (0 <= A ^ 2 * G' ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]). lra. }
        assert (M' : b * q <= w) by (apply Rnot_lt_le; intros B; assert (0 < A * (b * q - w)) by (apply Rmult_lt_0_compat; lra); lra).
        exists q. split; [exact Hq|]. unfold D. rewrite p_moves by lra. rewrite (x_before v q 0 A Hv x X0 X q) by lra.
        unfold G' in G0. lra.
  Qed.

  (* braking takes no more of the speed than at the rate k *)
  Lemma lost_rises k s s' : s <= s' -> 0 <= k -> s' <= 0 \/ (0 < T /\ s' <= T /\ A * s' <= k * T) \/ A <= k ->
    lost T A s' - lost T A s <= k * (s' - s).
  Proof.
    intros L K C. assert (Z : 0 <= k * (s' - s)) by (apply Rmult_le_pos; lra).
    destruct (Rle_lt_dec s' 0) as [N|N]; [rewrite !lost_before by lra; lra|].
    destruct C as [C|C]; [lra|].
    assert (slow : 0 < T -> s' <= T -> A * s' <= k * T -> lost T A s' - lost T A s <= k * (s' - s)).
    { intros PT M H. rewrite (lost_ramp T A s') by lra.
      destruct (Rle_lt_dec s 0) as [B|B].
      - rewrite lost_before by lra. apply Rmult_le_reg_r with (2 * T); [lra|].
        replace ((A * s' ^ 2 / (2 * T) - 0) * (2 * T)) with (A * s' * s') by (field; lra).
        assert (A * s' * s' <= k * T * s') by (apply Rmult_le_compat_r; lra).
        assert (0 <= k * T * s') by (apply Rmult_le_pos; [apply Rmult_le_pos; lra|lra]).
        assert (0 <= k * T * (- s)) by (apply Rmult_le_pos; [apply Rmult_le_pos; lra|lra]). lra.
      - rewrite (lost_ramp T A s) by lra. apply Rmult_le_reg_r with (2 * T); [lra|].
        replace ((A * s' ^ 2 / (2 * T) - A * s ^ 2 / (2 * T)) * (2 * T)) with (A * (s' + s) * (s' - s)) by (field; lra).
        assert (A * (s' + s) <= 2 * (k * T)) by nra.
        assert (A * (s' + s) * (s' - s) <= 2 * (k * T) * (s' - s)) by (apply Rmult_le_compat_r; lra). lra. }
    destruct C as [[PT [M H]]|C]; [apply slow; assumption|].
    assert (steep : forall z y, T <= z <= y -> lost T A y - lost T A z <= k * (y - z)).
    { intros z y H. rewrite !lost_full by lra. nra. }
    destruct (Rle_lt_dec s' T) as [M|M].
    - destruct (Rle_lt_or_eq_dec 0 T HT) as [PT|E]; [|lra]. apply slow; [exact PT|exact M|].
      apply Rle_trans with (A * T); [apply Rmult_le_compat_l; lra|apply Rmult_le_compat_r; lra].
    - destruct (Rle_lt_dec T s) as [F|F]; [apply steep; lra|].
      pose proof (steep T s' ltac:(lra)) as S1.
      assert (S2 : lost T A T - lost T A s <= k * (T - s)); [|lra].
      assert (K' : 0 <= k * (T - s)) by (apply Rmult_le_pos; lra).
      destruct (Rle_lt_or_eq_dec 0 T HT) as [PT|E].
      + rewrite (lost_ramp T A T) by lra. destruct (Rle_lt_dec s 0) as [B|B].
        * rewrite lost_before by lra. replace (A * T ^ 2 / (2 * T) - 0) with (A * T / 2) by (field; lra). nra.
        * rewrite (lost_ramp T A s) by lra.
          replace (A * T ^ 2 / (2 * T) - A * s ^ 2 / (2 * T)) with (A * (T + s) * (T - s) / (2 * T)) by (field; lra).
          apply Rmult_le_reg_r with (2 * T); [lra|].
          replace (A * (T + s) * (T - s) / (2 * T) * (2 * T)) with (A * (T + s) * (T - s)) by (field; lra).
          assert (A * (T + s) <= k * (2 * T)) by nra.
          assert (A * (T + s) * (T - s) <= k * (2 * T) * (T - s)) by (apply Rmult_le_compat_r; lra). lra.
      + rewrite !lost_before by lra. lra.
  Qed.
  (* where braking takes less of it than that of the other, no more than 0 was gained when speeds become equal *)
  Lemma nothing_yet t : 0 <= t -> b * t <= w -> lost T A (t - q) <= v -> gap_of t = 0 ->
    t - q <= 0 \/ (0 < T /\ t - q <= T /\ A * (t - q) <= b * T) \/ A <= b -> D t <= 0.
  Proof.
    intros H M N E C. assert (Z : D 0 = 0) by (unfold D; lra). rewrite <- Z.
    apply (falls D slope); [lra|intros; apply D_slope; lra|]. intros z Hz.
    assert (R : lost T A (t - q) - lost T A (z - q) <= b * ((t - q) - (z - q))) by (apply lost_rises; lra).
    assert (Pz : speed_at w 0 0 b z = w - b * z) by (apply p_speed; nra).
    unfold slope. rewrite Pz. unfold gap_of in E.
    assert (speed_at v q T A z <= w - b * z); [|lra]. apply Rmax_lub; [nra|lra].
  Qed.

  Theorem ever_braking : (exists t, 0 <= t /\ D t > g) <-> gainsBraking v w b g q T A.
  Proof.
    split; [|apply gains_then]. intros [t0 [T0 G0]].
    assert (Wb : b * (w / b) = w) by (field; lra). set (tw := w / b) in *. assert (W0 : 0 <= tw) by nra.
    set (te := Rmax t0 (Rmax tw (q + T + v / A))).
    assert (L1 : t0 <= te) by apply Rmax_l.
    assert (L2 : tw <= te) by (apply Rle_trans with (2 := Rmax_r _ _); apply Rmax_l).
    assert (L3 : q + T + v / A <= te) by (apply Rle_trans with (2 := Rmax_r _ _); apply Rmax_r).
    pose proof (stands_right te ltac:(nra) L3) as SL.
    assert (up : forall t u, tw <= t <= u -> D t <= D u).
    { intros t u H. apply (grows D slope); [lra|intros; apply D_slope; lra|]. intros z Hz.
      unfold slope. rewrite p_no_speed by nra. pose proof (Rmax_l 0 (v - lost T A (z - q))). unfold speed_at. lra. }
    destruct (Rlt_le_dec g (D te)) as [F|F]; [left; apply SL; exact F|right].
    assert (K : t0 < tw). { apply Rnot_le_lt. intros B. pose proof (up t0 te ltac:(lra)). lra. }
    destruct (continuity_ab_maj D 0 tw W0) as [t [M Ht]].
    { intros c C. apply derivable_continuous_pt. exists (slope c). apply D_slope. lra. }
    assert (G : g < D t) by (pose proof (M t0 ltac:(lra)); lra).
    assert (Z : D 0 = 0) by (unfold D; lra).
    assert (N0 : 0 < t). { destruct Ht as [[B|B] _]; [exact B|]. subst t. lra. }
    assert (N1 : t < tw). { destruct Ht as [_ [B|B]]; [exact B|]. subst t. pose proof (up tw te ltac:(lra)). lra. }
    assert (S : slope t = 0).
    { assert (pr : derivable_pt D t) by (exists (slope t); apply D_slope; lra).
      rewrite <- (deriv_maximum D 0 tw t pr N0 N1 ltac:(intros; apply M; lra)).
      symmetry. apply derive_pt_eq_0, D_slope. lra. }
    assert (Mv : 0 < w - b * t) by nra.
    assert (Lv : lost T A (t - q) <= v).
    { unfold slope in S. rewrite p_speed in S by lra. unfold speed_at, Rmax in S. destruct (Rle_dec 0 (v - lost T A (t - q))); lra. }
    rewrite slope_is in S by lra.
    pose proof (nothing_yet t ltac:(lra) ltac:(lra) Lv S) as none.
    assert (Q : q < t). { apply Rnot_le_lt. intros B. pose proof (none ltac:(left; lra)). lra. }
    assert (Ab : b < A \/ (b <= A /\ t - q <= T)).
    { destruct (Rlt_le_dec b A) as [B|B]; [left; exact B|]. pose proof (none ltac:(right; right; lra)). lra. }
    destruct (Rle_lt_dec (t - q) T) as [R|R].
    - right. assert (PT : 0 < T) by lra. set (s := t - q) in *. assert (Et : t = q + s) by (unfold s; ring).
      assert (S1 : b * T <= A * s).
      { apply Rnot_lt_le. intros B. pose proof (none ltac:(right; left; repeat split; lra)). lra. }
      unfold gap_of in S. fold s in S. rewrite lost_ramp in S by lra. set (e := v - w + b * q) in *.
      assert (E : A * s ^ 2 = 2 * T * (b * s + e)).
      { replace (A * s ^ 2) with (2 * T * (A * s ^ 2 / (2 * T))) by (field; lra). f_equal. unfold e. rewrite Et in S. lra. }
      rewrite Et in G, Mv. rewrite (ramp_reached s PT ltac:(lra) ltac:(lra) E) in G. fold e in G.
      set (k := w - b * q) in *. assert (Hk : b * s <= k) by (unfold k; lra). assert (V : v = e + k) by (unfold e, k; ring).
      unfold meetsInRamp. fold e k. set (G' := g - (v - w) * q - b * q ^ 2 / 2).
      assert (Gr : G' < 2 / 3 * e * s + b * s ^ 2 / 6) by (unfold G'; lra).
      repeat split.
      + destruct Ab; lra.
      + assert (0 <= (T - s) * (A * (T + s) - 2 * T * b)) by (apply Rmult_le_pos; [lra|nra]).
        apply Rmult_le_reg_l with T; [exact PT|]. unfold e in *. nra.
      + assert (b * (b * T) <= b * (A * s)) by (apply Rmult_le_compat_l; lra).
        assert (A * (b * s) <= A * k) by (apply Rmult_le_compat_l; lra). lra.
      + right. rewrite V. assert (0 <= (k - b * s) * (A * (k + b * s) - 2 * T * b ^ 2)) by (apply Rmult_le_pos; [lra|nra]).
        assert (A * (b * s) ^ 2 = b ^ 2 * (2 * T * (b * s + e))) by (rewrite <- E; ring). nra.
      + assert (Q1 : 0 <= (A * s - b * T) ^ 2) by apply pow2_ge_0.
        assert (Q2 : (A * s - b * T) ^ 2 = T * (T * b ^ 2 + 2 * A * e)).
        { replace ((A * s - b * T) ^ 2) with (A * (A * s ^ 2) - 2 * A * s * b * T + b ^ 2 * T ^ 2) by ring. rewrite E. ring. }
        rewrite Q2 in Q1. apply Rnot_lt_le. intros B. nra.
      + apply (some_right e b T s Hb); [lra|exact Gr].
      + apply (in_ramp_right e b T A s PT HA S1 E). exact Gr.
    - left. destruct Ab as [B|[_ B]]; [|lra].
      unfold gap_of in S. rewrite lost_full in S by lra.
      assert (E : (A - b) * t = v - w + A * (q + T / 2)) by lra.
      rewrite (full_reached t ltac:(lra) ltac:(lra) E) in G.
      unfold meetsInFull. rewrite <- E. repeat split; [lra|nra|nra|].
      apply (Rmult_lt_compat_l (24 * (A - b))) in G; [|lra].
      assert (Z' : 24 * (A - b) * ((A - b) * t ^ 2 / 2 - A * (q + T / 2) ^ 2 / 2 - A * T ^ 2 / 24)
        = 12 * ((A - b) * t) ^ 2 - (A - b) * (12 * A * (q + T / 2) ^ 2 + A * T ^ 2)) by field. lra.
  Qed.
End Both.
