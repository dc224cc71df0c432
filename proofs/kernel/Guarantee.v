(* The RSS guarantees for drives.  NOT TRUSTED: proved.

   Rss.v proves the longitudinal guarantee for positions that have speeds, and speeds with bounds on their change.
   Here it is proved of what drives are (Drive.v): accelerations that are constant in pieces and within bounds
   (`drives_keep_apart`).  The lateral guarantee follows, for motions (`motions_across`) and for drives
   (`drives_keep_apart_across`), with what fails where velocities keep the sign that the paper gives them. *)
From Coq Require Import Reals QArith Qreals List Lra Psatz.
From Roadproof Require Import Drive Rss.
Import ListNotations.
Open Scope R_scope.

Definition lasting (ps : list (Q * Q * Q)) : Prop := Forall (fun p => 0 < Q2R (fst (fst p))) ps.
Definition without_jerk (ps : list (Q * Q * Q)) : Prop := Forall (fun p => Q2R (snd p) = 0) ps.

Lemma moving_begins x v ps last : lasting ps ->
  place_ (moving x v ps last 0) = x /\ speed_ (moving x v ps last 0) = v.
Proof.
  intros L. destruct ps as [|[[d a] j] ps]; cbn [moving].
  - unfold moved. cbn [place_ speed_]. split; field.
  - inversion L as [|p l D _]. cbn [fst] in D. destruct (Rlt_dec 0 (Q2R d)) as [_|N]; [|exfalso; lra].
    unfold moved. cbn [place_ speed_]. split; field.
Qed.

(* --- what holds over one piece, and over two that follow each other, holds over all --------------------- *)
Section Chain.
  Variable said : R -> R -> Prop.                          (* of speed and acceleration at an instant *)
  Variable gained : R -> R -> R -> Prop.                   (* of a duration, the speed before and the speed after *)
  Hypothesis one : forall v a d, 0 <= d -> (forall t, 0 <= t < d -> said (v + a * t) a) -> gained d v (v + a * d).
  Hypothesis two : forall d e u v w, 0 <= d -> 0 <= e -> gained d u v -> gained e v w -> gained (d + e) u w.

  Lemma within_a_piece x v a j s u : j = 0 -> s <= u ->
    (forall t, s <= t < u -> said (speed_ (moved x v a j t)) (acceleration_ (moved x v a j t))) ->
    gained (u - s) (speed_ (moved x v a j s)) (speed_ (moved x v a j u)).
  Proof.
    intros -> S H. unfold moved in *. cbn [speed_ acceleration_] in *.
    replace (v + a * u + 0 * u ^ 2 / 2) with (v + a * s + 0 * s ^ 2 / 2 + a * (u - s)) by field. apply one; [lra|].
    intros t T. replace (v + a * s + 0 * s ^ 2 / 2 + a * t) with (v + a * (s + t) + 0 * (s + t) ^ 2 / 2) by field.
    replace a with (a + 0 * (s + t)) at 2 by ring. apply H. lra.
  Qed.

  Lemma chain last ps : lasting ps -> without_jerk ps -> forall x v s u, 0 <= s <= u ->
    (forall t, s <= t < u -> said (speed_ (moving x v ps last t)) (acceleration_ (moving x v ps last t))) ->
    gained (u - s) (speed_ (moving x v ps last s)) (speed_ (moving x v ps last u)).
  Proof.
    induction ps as [|[[d a] j] ps IH]; intros L J x v s u S H; cbn [moving] in *.
    - apply within_a_piece; [reflexivity|lra|exact H].
    - inversion L as [|p l D L']; subst p l. inversion J as [|p l J0 J']; subst p l. cbn [fst snd] in D, J0.
      specialize (IH L' J'). set (D' := Q2R d) in *. set (e := moved x v (Q2R a) (Q2R j) D') in *.
      destruct (Rlt_dec s D') as [A|A].
      + destruct (Rlt_dec u D') as [B|B].
        * apply within_a_piece; [exact J0|lra|]. intros t T. specialize (H t T).
          destruct (Rlt_dec t D') as [_|N]; [exact H|exfalso; lra].
        * replace (u - s) with ((D' - s) + (u - D' - 0)) by ring.
          destruct (moving_begins (place_ e) (speed_ e) ps last L') as [_ E].
          apply two with (v := speed_ e); [lra|lra| |].
          -- apply within_a_piece; [exact J0|lra|]. intros t T. assert (T' : s <= t < u) by lra. specialize (H t T').
             destruct (Rlt_dec t D') as [_|N]; [exact H|exfalso; lra].
          -- rewrite <- E at 1. apply IH; [lra|]. intros t T. assert (T' : s <= t + D' < u) by lra.
             specialize (H _ T'). destruct (Rlt_dec (t + D') D') as [N|_]; [exfalso; lra|].
             replace (t + D' - D') with t in H by ring. exact H.
      + destruct (Rlt_dec u D') as [B|_]; [exfalso; lra|].
        replace (u - s) with ((u - D') - (s - D')) by ring. apply IH; [lra|].
        intros t T. assert (T' : s <= t + D' < u) by lra. specialize (H _ T').
        destruct (Rlt_dec (t + D') D') as [N|_]; [exfalso; lra|].
        replace (t + D' - D') with t in H by ring. exact H.
  Qed.
End Chain.

(* --- positions have the speeds as derivatives, also where a piece ends ---------------------------------- *)
Lemma glued g h g' h' D t :
  (forall t, derivable_pt_lim g t (g' t)) -> (forall t, derivable_pt_lim h t (h' t)) -> g D = h D -> g' D = h' D ->
  derivable_pt_lim (fun t => if Rlt_dec t D then g t else h t) t (if Rlt_dec t D then g' t else h' t).
Proof.
  intros G H E E' eps P. destruct (G t eps P) as [dg Dg]. destruct (H t eps P) as [dh Dh].
  destruct (Rlt_dec t D) as [A|A].
  - assert (M : 0 < Rmin dg (D - t)) by (apply Rmin_pos; [apply cond_pos|lra]).
    exists (mkposreal _ M). intros k K S. cbn [pos] in S.
    pose proof (Rmin_l dg (D - t)). pose proof (Rmin_r dg (D - t)). pose proof (Rle_abs k).
    destruct (Rlt_dec (t + k) D) as [_|N]; [|exfalso; lra]. apply Dg; [exact K|lra].
  - destruct (Rlt_le_dec D t) as [B|B].
    + assert (M : 0 < Rmin dh (t - D)) by (apply Rmin_pos; [apply cond_pos|lra]).
      exists (mkposreal _ M). intros k K S. cbn [pos] in S.
      pose proof (Rmin_l dh (t - D)). pose proof (Rmin_r dh (t - D)).
      pose proof (Rle_abs (- k)). rewrite Rabs_Ropp in *.
      destruct (Rlt_dec (t + k) D) as [N|_]; [exfalso; lra|]. apply Dh; [exact K|lra].
    + assert (T : t = D) by lra. subst t. assert (M : 0 < Rmin dg dh) by (apply Rmin_pos; apply cond_pos).
      exists (mkposreal _ M). intros k K S. cbn [pos] in S. pose proof (Rmin_l dg dh). pose proof (Rmin_r dg dh).
      destruct (Rlt_dec (D + k) D) as [N|N].
      * rewrite <- E, <- E'. apply Dg; [exact K|lra].
      * apply Dh; [exact K|lra].
Qed.

Lemma moving_moves last ps : lasting ps -> forall x v t,
  derivable_pt_lim (fun t => place_ (moving x v ps last t)) t (speed_ (moving x v ps last t)).
Proof.
  assert (one : forall x v a j t,
    derivable_pt_lim (fun t => x + v * t + a * t ^ 2 / 2 + j * t ^ 3 / 6) t (v + a * t + j * t ^ 2 / 2)).
  { intros x v a j t.
    apply (derivable_pt_lim_ext (fun t => (x + (v * t + a * t ^ 2 / 2)) + j / 6 * t ^ 3)); [intros s; field|].
    replace (v + a * t + j * t ^ 2 / 2) with ((0 + (v + a * t)) + j / 6 * (INR 3 * t ^ pred 3)) by (simpl; field).
    apply (derivable_pt_lim_plus (fun t => x + (v * t + a * t ^ 2 / 2)) (fun t => j / 6 * t ^ 3)).
    - apply (derivable_pt_lim_plus (fun _ => x)); [apply derivable_pt_lim_const|apply parabola].
    - apply (derivable_pt_lim_scal (fun t => t ^ 3)), derivable_pt_lim_pow. }
  induction ps as [|[[d a] j] ps IH]; intros L x v t; cbn [moving].
  - apply one.
  - inversion L as [|p l D L']; subst p l. cbn [fst] in D. specialize (IH L').
    set (D' := Q2R d) in *. set (e := moved x v (Q2R a) (Q2R j) D') in *.
    pose proof (moving_begins (place_ e) (speed_ e) ps last L') as [B1 B2].
    set (h := fun t => place_ (moving (place_ e) (speed_ e) ps last (t - D'))).
    set (h' := fun t => speed_ (moving (place_ e) (speed_ e) ps last (t - D'))).
    assert (G : derivable_pt_lim
      (fun t => if Rlt_dec t D' then place_ (moved x v (Q2R a) (Q2R j) t) else h t) t
      (if Rlt_dec t D' then speed_ (moved x v (Q2R a) (Q2R j) t) else h' t)).
    { apply (glued (fun t => place_ (moved x v (Q2R a) (Q2R j) t)) h (fun t => speed_ (moved x v (Q2R a) (Q2R j) t)) h').
      - intros u. apply one.
      - intros u. unfold h, h'.
        replace (speed_ (moving (place_ e) (speed_ e) ps last (u - D')))
          with (speed_ (moving (place_ e) (speed_ e) ps last (u - D')) * 1) by ring.
        apply (derivable_pt_lim_comp (fun t => t - D') (fun t => place_ (moving (place_ e) (speed_ e) ps last t))).
        + replace 1 with (1 - 0) by ring.
          apply derivable_pt_lim_minus; [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
        + apply IH.
      - unfold h. replace (D' - D') with 0 by ring. rewrite B1. reflexivity.
      - unfold h'. replace (D' - D') with 0 by ring. rewrite B2. reflexivity. }
    apply (derivable_pt_lim_ext (fun t => if Rlt_dec t D' then place_ (moved x v (Q2R a) (Q2R j) t) else h t)).
    + intros u. destruct (Rlt_dec u D'); reflexivity.
    + destruct (Rlt_dec t D'); exact G.
Qed.

(* --- the guarantee -------------------------------------------------------------------------------------- *)
Section Guarantee.
  Variables a_max b_max b_min rho : R.
  Hypotheses (Ha : 0 <= a_max) (Hb : 0 < b_max) (Hm : 0 < b_min) (Hr : 0 <= rho) (Hmb : b_min <= b_max).

  Lemma brakes_at_most v a d : 0 <= d -> (forall t, 0 <= t < d -> a >= - b_max) -> v + a * d >= v - b_max * d.
  Proof.
    intros D H. destruct (Rle_lt_or_eq_dec 0 d D) as [P|<-]; [|lra]. assert (a >= - b_max) by (apply (H 0); lra). nra.
  Qed.
  Lemma speeds_up_at_most v a d : 0 <= d -> (forall t, 0 <= t < d -> a <= a_max) -> v + a * d <= v + a_max * d.
  Proof.
    intros D H. destruct (Rle_lt_or_eq_dec 0 d D) as [P|<-]; [|lra]. assert (a <= a_max) by (apply (H 0); lra). nra.
  Qed.
  Lemma brakes_at_least v a d : 0 <= d -> (forall t, 0 <= t < d -> 0 < v + a * t -> a <= - b_min) ->
    v + a * d <= Rmax 0 (v - b_min * d).
  Proof.
    intros D H. destruct (Rle_lt_dec (v + a * d) 0) as [N|P]; [apply Rle_trans with 0; [exact N|apply Rmax_l]|].
    destruct (Rle_lt_or_eq_dec 0 d D) as [Q'|<-].
    - apply Rle_trans with (v - b_min * d); [|apply Rmax_r].
      destruct (Rlt_le_dec 0 v) as [V|V].
      + assert (a <= - b_min) by (apply (H 0); lra). nra.
      + exfalso. assert (A : 0 < a) by nra. set (t := d - (v + a * d) / (2 * a)).
        assert (E : a * t = (a * d - v) / 2) by (unfold t; field; lra).
        assert (0 <= t) by nra. assert (0 < (v + a * d) / (2 * a)) by (apply Rdiv_lt_0_compat; lra).
        assert (a <= - b_min) by (apply (H t); [unfold t; unfold t in *; lra|lra]). lra.
    - apply Rle_trans with (v - b_min * 0); [lra|apply Rmax_r].
  Qed.
  Lemma brakes_on d e u v w : 0 <= d -> 0 <= e -> v <= Rmax 0 (u - b_min * d) -> w <= Rmax 0 (v - b_min * e) ->
    w <= Rmax 0 (u - b_min * (d + e)).
  Proof.
    intros D E. assert (0 <= b_min * d) by nra. assert (0 <= b_min * e) by nra.
    unfold Rmax. destruct (Rle_dec 0 (u - b_min * d)), (Rle_dec 0 (v - b_min * e)), (Rle_dec 0 (u - b_min * (d + e)));
      intros; lra.
  Qed.

  (* `rear` and `front` are courses along the road; the front vehicle's rear end is `long` behind its front.
     The front vehicle does not reverse and brakes by at most b_max.  The rear one speeds up by at most a_max until
     rho, and brakes by at least b_min from then on, while it moves forward. *)
  Theorem drives_keep_apart (rear front : course) (long : R) :
    lasting (pieces rear) -> lasting (pieces front) -> without_jerk (pieces rear) -> without_jerk (pieces front) ->
    (forall t, 0 <= t -> 0 <= speed_ (at_time front t)) ->
    (forall t, 0 <= t -> acceleration_ (at_time front t) >= - b_max) ->
    0 <= speed_ (at_time rear 0) ->
    (forall t, 0 <= t < rho -> acceleration_ (at_time rear t) <= a_max) ->
    (forall t, rho <= t -> 0 < speed_ (at_time rear t) -> acceleration_ (at_time rear t) <= - b_min) ->
    place_ (at_time front 0) - long - place_ (at_time rear 0)
      > dRSS a_max b_max b_min rho (speed_ (at_time rear 0)) (speed_ (at_time front 0)) ->
    forall t, 0 <= t -> place_ (at_time rear t) < place_ (at_time front t) - long.
  Proof.
    intros Lr Lf Jr Jf V Bf V0 Ar Br G.
    apply (motions a_max b_max b_min rho Ha Hb Hm Hr Hmb
      (fun t => place_ (at_time rear t)) (fun t => speed_ (at_time rear t))
      (fun t => place_ (at_time front t) - long) (fun t => speed_ (at_time front t))); try assumption.
    - intros t _. apply moving_moves, Lr.
    - intros t _. replace (speed_ (at_time front t)) with (speed_ (at_time front t) - 0) by ring.
      apply derivable_pt_lim_minus; [apply moving_moves, Lf|apply derivable_pt_lim_const].
    - intros s u S. unfold at_time.
      apply (chain (fun _ a => a >= - b_max) (fun d v w => w >= v - b_max * d)) with (s := s) (u := u); try assumption.
      + intros v a d D H. apply brakes_at_most; [exact D|]. intros t T. apply (H t T).
      + intros d e x v w D E H1 H2. lra.
      + intros t T. apply Bf. lra.
    - intros s u S U. unfold at_time.
      apply (chain (fun _ a => a <= a_max) (fun d v w => w <= v + a_max * d)) with (s := s) (u := u); try assumption.
      + intros v a d D H. apply speeds_up_at_most; [exact D|]. intros t T. apply (H t T).
      + intros d e x v w D E H1 H2. lra.
      + intros t T. apply Ar. lra.
    - intros s u S. unfold at_time.
      apply (chain (fun v a => 0 < v -> a <= - b_min) (fun d v w => w <= Rmax 0 (v - b_min * d)))
        with (s := s) (u := u); try assumption; [exact brakes_at_least|exact brakes_on|lra|].
      intros t T. apply Br. lra.
  Qed.
End Guarantee.

(* --- across the road ------------------------------------------------------------------------------------ *)
(* Vehicle 1 is left of vehicle 2.  Places and speeds are to the right, as in the paper's equation: v1 > 0 and
   v2 < 0 are towards each other.  `signed` counts the braking of those who move towards the other, as ad-rss does;
   `paper` squares whatever the speed is, which is no less. *)
Section Lateral.
  Variables a b rho : R.
  Hypotheses (Ha : 0 <= a) (Hb : 0 < b) (Hr : 0 <= rho).

  Definition signed v1 v2 :=
    Rmax 0 ((v1 - v2) * rho + a * rho ^ 2 + (Rmax 0 (v1 + rho * a) ^ 2 + Rmin 0 (v2 - rho * a) ^ 2) / (2 * b)).
  Definition paper v1 v2 :=
    Rmax 0 ((v1 - v2) * rho + a * rho ^ 2 + ((v1 + rho * a) ^ 2 + (v2 - rho * a) ^ 2) / (2 * b)).

  Lemma signed_below_paper v1 v2 : signed v1 v2 <= paper v1 v2.
  Proof.
    unfold signed, paper. apply Rle_max_compat_l, Rplus_le_compat_l.
    apply Rmult_le_compat_r; [left; apply Rinv_0_lt_compat; lra|].
    apply Rplus_le_compat; unfold Rmax, Rmin; destruct (Rle_dec _ _); nra.
  Qed.

  (* from place x c on, with a speed of at most w that is braked by b *)
  Lemma brakes_within x v c t w : 0 <= w -> c <= t -> (forall s, c <= s <= t -> derivable_pt_lim x s (v s)) ->
    (forall s, c <= s <= t -> v s <= Rmax 0 (w - b * (s - c))) -> x t - x c <= w ^ 2 / (2 * b).
  Proof.
    intros W C D H. pose proof (times_over w b Hb) as Q'. set (q := w / b) in *. assert (0 <= q) by nra.
    assert (E : w ^ 2 / (2 * b) = w * q / 2) by (unfold q; field; lra). rewrite E.
    assert (first : forall u, c <= u <= t -> u - c <= q -> x u - x c <= w * (u - c) - b * (u - c) ^ 2 / 2).
    { intros u U B. pose proof (gains x v (fun s => w * (s - c) + - b * (s - c) ^ 2 / 2)
        (fun s => w + - b * (s - c)) c u) as G. cbv beta in G.
      assert (K : x u - x c <= w * (u - c) + - b * (u - c) ^ 2 / 2 - (w * (c - c) + - b * (c - c) ^ 2 / 2)).
      { apply G; [lra|intros s S; apply D; lra|intros s _; apply shifted|].
        intros s S. assert (T : c <= s <= t) by lra. specialize (H s T).
        rewrite Rmax_right in H by nra. lra. }
      replace (c - c) with 0 in K by ring. lra. }
    destruct (Rle_lt_dec (t - c) q) as [B|B].
    - specialize (first t (conj C (Rle_refl t)) B). set (z := t - c) in *.
      assert (0 <= b * (q - z) ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]).
      assert (w * q / 2 - (w * z - b * z ^ 2 / 2) = b * (q - z) ^ 2 / 2) by (rewrite <- Q'; field). lra.
    - assert (U : c <= c + q <= t) by lra. specialize (first (c + q) U). replace (c + q - c) with q in first by ring.
      specialize (first (Rle_refl q)).
      assert (x t - x (c + q) <= 0 - 0).
      { apply (gains x v (fun _ => 0) (fun _ => 0)); [lra|intros s S; apply D; lra|intros s _; apply still|].
        intros s S. assert (T : c <= s <= t) by lra. specialize (H s T). rewrite Rmax_left in H; [exact H|nra]. }
      assert (w * q - b * q ^ 2 / 2 = w * q / 2) by (rewrite <- Q'; field). lra.
  Qed.

  Lemma reaches x v t : moves x v -> 0 <= t ->
    (forall s u, 0 <= s <= u -> u <= rho -> v u <= v s + a * (u - s)) ->
    (forall s u, rho <= s <= u -> v u <= Rmax 0 (v s - b * (u - s))) ->
    (t <= rho -> x t - x 0 <= v 0 * t + a * t ^ 2 / 2)
    /\ (rho <= t -> x t - x 0 <= v 0 * rho + a * rho ^ 2 / 2 + Rmax 0 (v 0 + rho * a) ^ 2 / (2 * b)).
  Proof.
    intros D T A B.
    assert (first : forall u, 0 <= u <= rho -> x u - x 0 <= v 0 * u + a * u ^ 2 / 2).
    { intros u U. pose proof (gains x v (fun s => v 0 * s + a * s ^ 2 / 2) (fun s => v 0 + a * s) 0 u) as G.
      cbv beta in G.
      assert (x u - x 0 <= v 0 * u + a * u ^ 2 / 2 - (v 0 * 0 + a * 0 ^ 2 / 2)); [|lra].
      apply G; [lra|intros s S; apply D; lra|intros s _; apply parabola|].
      intros s S. assert (v s <= v 0 + a * (s - 0)) by (apply A; lra). lra. }
    split; [intros L; apply first; lra|intros L]. specialize (first rho (conj Hr (Rle_refl rho))).
    assert (v rho <= v 0 + a * (rho - 0)) by (apply A; lra).
    assert (x t - x rho <= Rmax 0 (v 0 + rho * a) ^ 2 / (2 * b)); [|lra].
    apply brakes_within with (v := v); [apply Rmax_l|exact L|intros s S; apply D; lra|].
    intros s S. apply Rle_trans with (Rmax 0 (v rho - b * (s - rho))); [apply B; lra|].
    apply Rle_max_compat_l. pose proof (Rmax_r 0 (v 0 + rho * a)). lra.
  Qed.

  Theorem motions_across x1 v1 x2 v2 : moves x1 v1 -> moves x2 v2 ->
    (forall s u, 0 <= s <= u -> u <= rho -> v1 u <= v1 s + a * (u - s)) ->
    (forall s u, 0 <= s <= u -> u <= rho -> - v2 u <= - v2 s + a * (u - s)) ->
    (forall s u, rho <= s <= u -> v1 u <= Rmax 0 (v1 s - b * (u - s))) ->
    (forall s u, rho <= s <= u -> - v2 u <= Rmax 0 (- v2 s - b * (u - s))) ->
    x2 0 - x1 0 > signed (v1 0) (v2 0) ->
    forall t, 0 <= t -> x1 t < x2 t.
  Proof.
    intros D1 D2 A1 A2 B1 B2 G t T.
    destruct (reaches x1 v1 t D1 T A1 B1) as [N1 F1].
    assert (D2' : moves (fun t => - x2 t) (fun t => - v2 t)).
    { intros s S. apply (derivable_pt_lim_opp x2). apply D2, S. }
    destruct (reaches (fun t => - x2 t) (fun t => - v2 t) t D2' T A2 B2) as [N2 F2]. cbv beta in *.
    unfold signed in G. set (u1 := v1 0) in *. set (u2 := v2 0) in *.
    assert (M : Rmax 0 (- u2 + rho * a) ^ 2 = Rmin 0 (u2 - rho * a) ^ 2).
    { unfold Rmax, Rmin. destruct (Rle_dec 0 (- u2 + rho * a)), (Rle_dec 0 (u2 - rho * a)); nra. }
    rewrite M in F2. set (p := Rmax 0 (u1 + rho * a) ^ 2) in *. set (q := Rmin 0 (u2 - rho * a) ^ 2) in *.
    assert (P : 0 <= p) by apply pow2_ge_0. assert (Q' : 0 <= q) by apply pow2_ge_0.
    assert (K : 0 < / (2 * b)) by (apply Rinv_0_lt_compat; lra). unfold Rdiv in *.
    pose proof (Rmax_l 0 ((u1 - u2) * rho + a * rho ^ 2 + (p + q) * / (2 * b))).
    pose proof (Rmax_r 0 ((u1 - u2) * rho + a * rho ^ 2 + (p + q) * / (2 * b))).
    assert (0 <= (p + q) * / (2 * b)) by (apply Rmult_le_pos; lra).
    destruct (Rle_lt_dec t rho) as [L|L].
    - specialize (N1 L). specialize (N2 L).
      assert (S : x1 t - x1 0 - (x2 t - x2 0) <= t * (u1 - u2 + a * t)) by lra.
      destruct (Rle_lt_dec (u1 - u2 + a * t) 0) as [Z|Z].
      + assert (t * (u1 - u2 + a * t) <= 0) by nra. lra.
      + assert (u1 - u2 + a * t <= u1 - u2 + a * rho) by nra.
        assert (t * (u1 - u2 + a * t) <= rho * (u1 - u2 + a * rho)) by (apply Rmult_le_compat; lra). lra.
    - assert (L' : rho <= t) by lra. specialize (F1 L'). specialize (F2 L'). lra.
  Qed.

  (* `left` and `right` are courses across the road, on which places grow to the left; the right side of the left
     vehicle is `wide` from its left one.  Each moves towards the other by at most a more until rho, and brakes by at
     least b from then on, while it moves towards it. *)
  Theorem drives_keep_apart_across (left right : course) (wide : R) :
    lasting (pieces left) -> lasting (pieces right) -> without_jerk (pieces left) -> without_jerk (pieces right) ->
    (forall t, 0 <= t < rho -> - acceleration_ (at_time left t) <= a) ->
    (forall t, 0 <= t < rho -> acceleration_ (at_time right t) <= a) ->
    (forall t, rho <= t -> speed_ (at_time left t) < 0 -> acceleration_ (at_time left t) >= b) ->
    (forall t, rho <= t -> 0 < speed_ (at_time right t) -> acceleration_ (at_time right t) <= - b) ->
    place_ (at_time left 0) - wide - place_ (at_time right 0)
      > signed (- speed_ (at_time left 0)) (- speed_ (at_time right 0)) ->
    forall t, 0 <= t -> place_ (at_time right t) < place_ (at_time left t) - wide.
  Proof.
    intros Ll Lr Jl Jr A1 A2 B1 B2 G t T.
    assert (K : - (place_ (at_time left t) - wide) < - place_ (at_time right t)); [|lra].
    apply (motions_across
      (fun t => - (place_ (at_time left t) - wide)) (fun t => - speed_ (at_time left t))
      (fun t => - place_ (at_time right t)) (fun t => - speed_ (at_time right t))); try exact T.
    - intros s _. apply (derivable_pt_lim_opp (fun t => place_ (at_time left t) - wide)).
      replace (speed_ (at_time left s)) with (speed_ (at_time left s) - 0) by ring.
      apply derivable_pt_lim_minus; [apply moving_moves, Ll|apply derivable_pt_lim_const].
    - intros s _. apply (derivable_pt_lim_opp (fun t => place_ (at_time right t))). apply moving_moves, Lr.
    - intros s u S U. unfold at_time.
      apply (chain (fun _ r => - r <= a) (fun d v w => - w <= - v + a * d)) with (s := s) (u := u); try assumption.
      + intros v r d D H. pose proof (speeds_up_at_most a (- v) (- r) d D H). lra.
      + intros d e x v w D E H1 H2. lra.
      + intros r R'. apply A1. lra.
    - intros s u S U. rewrite !Ropp_involutive. unfold at_time.
      apply (chain (fun _ r => r <= a) (fun d v w => w <= v + a * d)) with (s := s) (u := u); try assumption.
      + intros v r d D H. apply speeds_up_at_most; [exact D|exact H].
      + intros d e x v w D E H1 H2. lra.
      + intros r R'. apply A2. lra.
    - intros s u S. unfold at_time.
      apply (chain (fun v r => v < 0 -> r >= b) (fun d v w => - w <= Rmax 0 (- v - b * d))) with (s := s) (u := u);
        try assumption.
      + intros v r d D H. replace (- (v + r * d)) with (- v + - r * d) by ring. apply brakes_at_least; try assumption.
        intros r' R' P. assert (r >= b) by (apply (H r' R'); lra). lra.
      + intros d e x v w D E H1 H2. apply (brakes_on b Hb d e (- x) (- v) (- w) D E H1 H2).
      + lra.
      + intros r R'. apply B1. lra.
    - intros s u S. rewrite !Ropp_involutive. unfold at_time.
      apply (chain (fun v r => 0 < v -> r <= - b) (fun d v w => w <= Rmax 0 (v - b * d))) with (s := s) (u := u);
        try assumption; [exact (brakes_at_least b Hb)|exact (brakes_on b Hb)|lra|].
      intros r R'. apply B2. lra.
    - lra.
  Qed.
End Lateral.

(* As the paper prints it, v_lat goes into its equation unchanged, although d grows to the left (the option
   lateral_sign = literal).  Then the distance of vehicles that approach each other by 1 m/s each is 0 at the
   declared values, where they are to be more than 4 m apart. *)
Lemma literal_sign_asks_for_nothing : paper (3 / 2) (3 / 2) (3 / 5) (- (1)) 1 = 0.
Proof. unfold paper. apply Rmax_left. lra. Qed.
Lemma right_sign_asks_for_more : paper (3 / 2) (3 / 2) (3 / 5) 1 (- (1)) > 4.
Proof. unfold paper. pose proof (Rmax_r 0 ((1 - - (1)) * (3 / 5) + 3 / 2 * (3 / 5) ^ 2 +
  ((1 + 3 / 5 * (3 / 2)) ^ 2 + (- (1) - 3 / 5 * (3 / 2)) ^ 2) / (2 * (3 / 2)))). lra. Qed.
