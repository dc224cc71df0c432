(* Drives are motions.  NOT TRUSTED: proved.

   Drive.v says what the world of a drive is, and Motion.v what a motion is.  `drives_move`: where the pieces of a
   drive last, its world is a motion.  So a drive that shows that a claim is false refutes it under motion, too. *)
From Coq Require Import Reals RList QArith Qreals String List Bool Arith Eqdep_dec Lra Lia.
From Roadproof Require Import Meaning Drive Guarantee Motion Integral.
Import ListNotations.
Open Scope R_scope.

(* --- what is put together of two ------------------------------------------------------------------------ *)
Definition from_on (k : R) (F f : R -> R) : Prop :=
  forall s t, k <= s <= t -> exists integrable : Riemann_integrable f s t, F t - F s = RiemannInt integrable.
Lemma from_later k F f : 0 <= k -> is_integral F f -> from_on k F f.
Proof. intros K H s t T. apply H. lra. Qed.

Definition spike (d t : R) : R := if Req_EM_T t d then 1 else 0.
Lemma spike_steps s d : s < d -> IsStepFun (spike d) s d.
Proof.
  intros S. exists (s :: d :: nil). exists (0 :: nil). repeat split.
  - intros i I. cbn in I. replace i with 0%nat by lia. cbn. lra.
  - cbn. rewrite Rmin_left; lra.
  - cbn. rewrite Rmax_right; lra.
  - intros i I. cbn in I. replace i with 0%nat by lia. intros u [_ U]. cbn in *. unfold spike.
    destruct (Req_EM_T u d); [lra|reflexivity].
Qed.
Lemma step_integrable f a b : IsStepFun f a b -> Riemann_integrable f a b.
Proof.
  intros S eps. exists (mkStepFun S). exists (mkStepFun (StepFun_P4 a b 0)). split.
  - intros t _. cbn [fe]. unfold fct_cte. rewrite Rminus_diag_eq, Rabs_R0; [lra|reflexivity].
  - rewrite StepFun_P18, Rmult_0_l, Rabs_R0. apply cond_pos.
Qed.
(* what differs at the last instant alone *)
Lemma ends_otherwise f g s d : s <= d -> Riemann_integrable f s d -> (forall u, s <= u < d -> g u = f u) ->
  Riemann_integrable g s d.
Proof.
  intros S I E. destruct (Rle_lt_or_eq_dec s d S) as [L|<-]; [|apply RiemannInt_P7].
  apply (Riemann_integrable_ext (f := fun u => f u + (g d - f d) * spike d u)).
  - rewrite Rmin_left, Rmax_right by exact S. intros u U. unfold spike. destruct (Req_EM_T u d) as [N|N]; [subst u; lra|].
    rewrite (E u); lra.
  - apply RiemannInt_P10; [exact I|apply step_integrable, spike_steps, L].
Qed.
Lemma ends_together F f G g s d : s <= d -> F d = G d -> F s = G s \/ s = d -> (forall u, s <= u < d -> g u = f u) ->
  (exists p : Riemann_integrable f s d, F d - F s = RiemannInt p) ->
  exists q : Riemann_integrable g s d, G d - G s = RiemannInt q.
Proof.
  intros S E E' H [p P]. exists (ends_otherwise f g s d S p H).
  rewrite (RiemannInt_P18 _ p S); [|intros u U; apply H; lra].
  rewrite <- P. destruct E' as [E'|E']; [lra|]. rewrite <- E' in *. lra.
Qed.
Lemma same_on F f G g s t : s <= t -> (forall u, s <= u <= t -> F u = G u /\ f u = g u) ->
  (exists p : Riemann_integrable f s t, F t - F s = RiemannInt p) ->
  exists q : Riemann_integrable g s t, G t - G s = RiemannInt q.
Proof.
  intros S H [p P].
  assert (q : Riemann_integrable g s t).
  { apply (Riemann_integrable_ext (f := f)); [|exact p]. rewrite Rmin_left, Rmax_right by exact S. intros u U. apply H, U. }
  exists q. rewrite (RiemannInt_P18 q p S); [|intros u U; symmetry; apply H; lra].
  rewrite <- P. rewrite (proj1 (H t ltac:(lra))), (proj1 (H s ltac:(lra))). reflexivity.
Qed.
Lemma joined k d F f F1 f1 F2 f2 : k <= d -> from_on k F1 f1 -> from_on d F2 f2 -> F1 d = F2 d ->
  (forall t, k <= t < d -> F t = F1 t /\ f t = f1 t) -> (forall t, d <= t -> F t = F2 t /\ f t = f2 t) ->
  from_on k F f.
Proof.
  intros K A B E H1 H2 s t T.
  assert (late : forall s, d <= s <= t -> exists p : Riemann_integrable f s t, F t - F s = RiemannInt p).
  { intros r R. apply (same_on F2 f2); [lra| |apply B, R]. intros u U.
    destruct (H2 u ltac:(lra)) as [<- <-]. split; reflexivity. }
  destruct (Rlt_le_dec s d) as [S|S]; [|apply late; lra].
  destruct (Rlt_le_dec t d) as [U|U].
  - apply (same_on F1 f1); [lra| |apply A, T]. intros u V. destruct (H1 u ltac:(lra)) as [<- <-]. split; reflexivity.
  - destruct (late d ltac:(lra)) as [q Q].
    destruct (ends_together F1 f1 F f s d) as [p P]; [lra| | | |apply A; lra|].
    + rewrite (proj1 (H2 d ltac:(lra))). exact E.
    + left. symmetry. apply H1. lra.
    + intros u V. apply H1. lra.
    + exists (RiemannInt_P24 p q). rewrite <- (RiemannInt_P26 p q). lra.
Qed.

(* --- drives --------------------------------------------------------------------------------------------- *)
Lemma integral_cubic k : is_integral (fun t => (t - k) ^ 3 / 6) (fun t => (t - k) ^ 2 / 2).
Proof.
  apply integral_of_derivative; [|reg].
  intros t. apply (derivable_pt_lim_ext (fun t => / 6 * (t - k) ^ 3)); [intros u; field|].
  replace ((t - k) ^ 2 / 2) with (/ 6 * (INR 3 * (t - k) ^ pred 3 * (1 - 0))) by (simpl; field).
  apply derivable_pt_lim_scal, (derivable_pt_lim_comp (fun t => t - k) (fun x => x ^ 3)).
  - apply derivable_pt_lim_minus; [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
  - apply derivable_pt_lim_pow.
Qed.
Lemma moved_speeds x v a j k : 0 <= k ->
  from_on k (fun t => place_ (moved x v a j (t - k))) (fun t => speed_ (moved x v a j (t - k))).
Proof.
  intros K. apply from_later; [exact K|].
  apply (same_integral (fun t => x + (v * (t - k) + a * (t - k) ^ 2 / 2) + j * ((t - k) ^ 3 / 6))
    (fun t => 0 + (v + a * (t - k)) + j * ((t - k) ^ 2 / 2)));
    [intros t; unfold moved; cbn [place_]; field|intros t; unfold moved; cbn [speed_]; field|].
  apply integral_combined; [|apply integral_cubic].
  apply (integral_plus (fun _ => x) (fun _ => 0)); [apply integral_constant|apply integral_quadratic].
Qed.
Lemma moved_accelerates x v a j k : 0 <= k ->
  from_on k (fun t => speed_ (moved x v a j (t - k))) (fun t => acceleration_ (moved x v a j (t - k))).
Proof.
  intros K. apply from_later; [exact K|].
  apply (same_integral (fun t => v + (a * (t - k) + j * (t - k) ^ 2 / 2)) (fun t => 0 + (a + j * (t - k))));
    [intros t; unfold moved; cbn [speed_]; ring|intros t; unfold moved; cbn [acceleration_]; ring|].
  apply (integral_plus (fun _ => v) (fun _ => 0)); [apply integral_constant|apply integral_quadratic].
Qed.
Lemma moving_is_integral last ps : lasting ps -> forall x v k, 0 <= k ->
  from_on k (fun t => place_ (moving x v ps last (t - k))) (fun t => speed_ (moving x v ps last (t - k)))
  /\ from_on k (fun t => speed_ (moving x v ps last (t - k))) (fun t => acceleration_ (moving x v ps last (t - k))).
Proof.
  induction ps as [|[[d a] j] ps IH]; intros L x v k K; cbn [moving].
  - split; [apply moved_speeds, K|apply moved_accelerates, K].
  - inversion L as [|p l D L']; subst p l. cbn [fst] in D. set (d' := Q2R d) in *.
    set (e := moved x v (Q2R a) (Q2R j) d'). destruct (IH L' (place_ e) (speed_ e) (k + d') ltac:(lra)) as [I1 I2].
    pose proof (moving_begins (place_ e) (speed_ e) ps last L') as [B1 B2].
    assert (before : forall t, k <= t < k + d' -> t - k < d') by (intros; lra).
    assert (after : forall t, k + d' <= t -> ~ t - k < d' /\ t - k - d' = t - (k + d')) by (intros; split; lra).
    split.
    + refine (joined k (k + d') _ _ _ _ _ _ _ (moved_speeds x v (Q2R a) (Q2R j) k K) I1 _ _ _); [lra| | |].
      * replace (k + d' - k) with d' by ring. replace (k + d' - (k + d')) with 0 by ring. symmetry. exact B1.
      * intros t T. destruct (Rlt_dec (t - k) d') as [_|N]; [split; reflexivity|exfalso; apply N, before, T].
      * intros t T. destruct (after t T) as [N ->]. destruct (Rlt_dec (t - k) d') as [Y|_]; [exfalso; exact (N Y)|].
        split; reflexivity.
    + refine (joined k (k + d') _ _ _ _ _ _ _ (moved_accelerates x v (Q2R a) (Q2R j) k K) I2 _ _ _); [lra| | |].
      * replace (k + d' - k) with d' by ring. replace (k + d' - (k + d')) with 0 by ring. symmetry. exact B2.
      * intros t T. destruct (Rlt_dec (t - k) d') as [_|N]; [split; reflexivity|exfalso; apply N, before, T].
      * intros t T. destruct (after t T) as [N ->]. destruct (Rlt_dec (t - k) d') as [Y|_]; [exfalso; exact (N Y)|].
        split; reflexivity.
Qed.

Definition keeps (c : course) : Prop := lasting (pieces c).
Definition all_last (D : drive) : Prop :=
  Forall (fun entry => keeps (along (snd entry)) /\ keeps (across (snd entry))) (bodies D).

Lemma course_moves c : keeps c -> is_integral (fun t => place_ (at_time c t)) (fun t => speed_ (at_time c t))
  /\ is_integral (fun t => speed_ (at_time c t)) (fun t => acceleration_ (at_time c t)).
Proof.
  intros L. destruct (moving_is_integral (finally c) (pieces c) L (Q2R (starts_at c)) (Q2R (starts_with c)) 0)
    as [A B]; [lra|].
  split; [revert A|revert B]; apply same_integral; intros t; unfold at_time; rewrite Rminus_0_r; reflexivity.
Qed.

(* Only signals that a specification declares are in steps: in traces that refute claims all are. *)
Definition is_own (n : signal) : Prop := match n with Own _ => True | _ => False end.
Definition own_in_steps (D : drive) : Prop := Forall (fun entry => is_own (fst (fst entry))) (signals D).

Section Drive.
  Variable D : drive.
  Hypothesis L : all_last D.
  Hypothesis O : own_in_steps D.
  Hypothesis once : repeats D = None.
  Lemma not_in_steps n a : ~ is_own n -> steps_of D n a = None.
  Proof.
    intros N. unfold steps_of. match goal with |- context [find ?p ?l] => destruct (find p l) as [entry|] eqn:E end; [|reflexivity].
    apply find_some in E as [I E]. destruct (same_signal n (fst (fst entry))) as [->|]; [|discriminate].
    unfold own_in_steps in O. rewrite Forall_forall in O. exfalso. exact (N (O entry I)).
  Qed.
  Lemma body_keeps a : keeps (along (body_of D a)) /\ keeps (across (body_of D a)).
  Proof.
    unfold body_of, look_up. destruct (find (fun entry => String.eqb a (fst entry)) (bodies D)) as [entry|] eqn:E.
    - apply find_some in E as [E _]. unfold all_last in L. rewrite Forall_forall in L. exact (L entry E).
    - split; constructor.
  Qed.
  Theorem drives_move : motion (world_of D).
  Proof.
    split.
    - intros n r a E. destruct (body_keeps a) as [A B]. apply course_moves in A as [A1 A2].
      apply course_moves in B as [B1 B2].
      destruct n; cbn in E; try discriminate; injection E as <-; cbn [value world_of];
        unfold value_of, folded; rewrite !not_in_steps by exact (fun H => H); rewrite once; assumption.
    - exists (map (element_number D) (seq 0 (List.length (rectangles D)))). intros [k K].
      apply in_map_iff. exists k. split; [|apply in_seq; apply Nat.ltb_lt in K; lia].
      unfold element_number. destruct (bool_dec _ true) as [H|H]; [|exfalso; apply H, K].
      f_equal. apply UIP_dec, bool_dec.
  Qed.
End Drive.

Theorem refuted bounds claim D : all_last D -> own_in_steps D -> repeats D = None ->
  shows D bounds (Not claim) -> ~ valid_of_motions bounds claim.
Proof. intros L O N [B H] V. apply H. exact (V (world_of D) _ (drives_move D L O N) B). Qed.
