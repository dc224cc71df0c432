(* The longitudinal RSS guarantee for drives.  NOT TRUSTED: proved.

   Rss.v proves the guarantee for positions that have speeds, and speeds with bounds on their change.  Here it is
   proved of what drives are (Drive.v): accelerations that are constant in pieces and within bounds.  The theorem
   `drives_keep_apart` is at the end. *)
From Coq Require Import Reals QArith Qreals List Lra Psatz.
From Roadproof Require Import Drive Rss.
Import ListNotations.
Open Scope R_scope.

Definition lasting (ps : list (Q * Q)) : Prop := Forall (fun p => 0 < Q2R (fst p)) ps.

Lemma moving_begins x v ps last : lasting ps ->
  place_ (moving x v ps last 0) = x /\ speed_ (moving x v ps last 0) = v.
Proof.
  intros L. destruct ps as [|[d a] ps]; cbn [moving].
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

  Lemma within_a_piece x v a s u : s <= u ->
    (forall t, s <= t < u -> said (speed_ (moved x v a t)) a) ->
    gained (u - s) (speed_ (moved x v a s)) (speed_ (moved x v a u)).
  Proof.
    intros S H. unfold moved in *. cbn [speed_] in *.
    replace (v + a * u) with (v + a * s + a * (u - s)) by ring. apply one; [lra|].
    intros t T. replace (v + a * s + a * t) with (v + a * (s + t)) by ring. apply H. lra.
  Qed.

  Lemma chain last ps : lasting ps -> forall x v s u, 0 <= s <= u ->
    (forall t, s <= t < u -> said (speed_ (moving x v ps last t)) (acceleration_ (moving x v ps last t))) ->
    gained (u - s) (speed_ (moving x v ps last s)) (speed_ (moving x v ps last u)).
  Proof.
    induction ps as [|[d a] ps IH]; intros L x v s u S H; cbn [moving] in *.
    - apply within_a_piece; [lra|exact H].
    - inversion L as [|p l D L']; subst p l. cbn [fst] in D. specialize (IH L').
      set (D' := Q2R d) in *. set (e := moved x v (Q2R a) D') in *.
      destruct (Rlt_dec s D') as [A|A].
      + destruct (Rlt_dec u D') as [B|B].
        * apply within_a_piece; [lra|]. intros t T. specialize (H t T).
          destruct (Rlt_dec t D') as [_|N]; [exact H|exfalso; lra].
        * replace (u - s) with ((D' - s) + (u - D' - 0)) by ring.
          destruct (moving_begins (place_ e) (speed_ e) ps last L') as [_ E].
          apply two with (v := speed_ e); [lra|lra| |].
          -- apply within_a_piece; [lra|]. intros t T. assert (T' : s <= t < u) by lra. specialize (H t T').
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
  assert (one : forall x v a t, derivable_pt_lim (fun t => x + v * t + a * t ^ 2 / 2) t (v + a * t)).
  { intros x v a t. apply (derivable_pt_lim_ext (fun t => x + (v * t + a * t ^ 2 / 2))); [intros s; ring|].
    replace (v + a * t) with (0 + (v + a * t)) by ring.
    apply (derivable_pt_lim_plus (fun _ => x)); [apply derivable_pt_lim_const|apply parabola]. }
  induction ps as [|[d a] ps IH]; intros L x v t; cbn [moving].
  - apply one.
  - inversion L as [|p l D L']; subst p l. cbn [fst] in D. specialize (IH L').
    set (D' := Q2R d) in *. set (e := moved x v (Q2R a) D') in *.
    pose proof (moving_begins (place_ e) (speed_ e) ps last L') as [B1 B2].
    set (h := fun t => place_ (moving (place_ e) (speed_ e) ps last (t - D'))).
    set (h' := fun t => speed_ (moving (place_ e) (speed_ e) ps last (t - D'))).
    assert (G : derivable_pt_lim
      (fun t => if Rlt_dec t D' then place_ (moved x v (Q2R a) t) else h t) t
      (if Rlt_dec t D' then speed_ (moved x v (Q2R a) t) else h' t)).
    { apply (glued (fun t => place_ (moved x v (Q2R a) t)) h (fun t => speed_ (moved x v (Q2R a) t)) h').
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
    apply (derivable_pt_lim_ext (fun t => if Rlt_dec t D' then place_ (moved x v (Q2R a) t) else h t)).
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
    lasting (pieces rear) -> lasting (pieces front) ->
    (forall t, 0 <= t -> 0 <= speed_ (at_time front t)) ->
    (forall t, 0 <= t -> acceleration_ (at_time front t) >= - b_max) ->
    0 <= speed_ (at_time rear 0) ->
    (forall t, 0 <= t < rho -> acceleration_ (at_time rear t) <= a_max) ->
    (forall t, rho <= t -> 0 < speed_ (at_time rear t) -> acceleration_ (at_time rear t) <= - b_min) ->
    place_ (at_time front 0) - long - place_ (at_time rear 0)
      > dRSS a_max b_max b_min rho (speed_ (at_time rear 0)) (speed_ (at_time front 0)) ->
    forall t, 0 <= t -> place_ (at_time rear t) < place_ (at_time front t) - long.
  Proof.
    intros Lr Lf V Bf V0 Ar Br G.
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
