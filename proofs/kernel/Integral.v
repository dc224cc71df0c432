(* Functions that grow by integrals.  NOT TRUSTED: proved.

   What the schemas of motion (Schemas.v) need of `is_integral` of Motion.v, and of `lingers`: sums and multiples, bounds
   on growth, continuity, and the first and last instants of what is true for a while.  Functions are of times from 0
   on: they are continued before 0 by their value at 0, so that Coq's library of continuous functions is of use. *)
From Coq Require Import Reals RList Lra Lia Classical FunctionalExtensionality.
From Roadproof Require Import Meaning Motion.
Open Scope R_scope.

(* What is true at an instant is true for a while before and after it. *)
Definition lingers (p : R -> Prop) : Prop :=
  forall t, 0 <= t -> p t -> exists while, 0 < while /\ forall u, 0 <= u -> t - while < u < t + while -> p u.

Lemma same_integral F f G g : (forall t, F t = G t) -> (forall t, f t = g t) -> is_integral F f -> is_integral G g.
Proof.
  intros E e. rewrite (functional_extensionality F G E), (functional_extensionality f g e). trivial.
Qed.

(* --- sums, multiples, constants ------------------------------------------------------------------------- *)
Lemma integral_combined F f G g c :
  is_integral F f -> is_integral G g -> is_integral (fun t => F t + c * G t) (fun t => f t + c * g t).
Proof.
  intros A B s t T. destruct (A s t T) as [p P]. destruct (B s t T) as [q Q].
  exists (RiemannInt_P10 c p q). rewrite (RiemannInt_P13 p q), <- P, <- Q. ring.
Qed.
Lemma integral_linear c k : is_integral (fun t => c * t + k) (fun _ => c).
Proof.
  intros s t T. exists (RiemannInt_P14 s t c). transitivity (c * (t - s)); [ring|symmetry; apply RiemannInt_P15].
Qed.
Lemma integral_constant k : is_integral (fun _ => k) (fun _ => 0).
Proof.
  apply (same_integral (fun t => 0 * t + k) (fun _ => 0)); [intros t; ring|reflexivity|apply integral_linear].
Qed.
Lemma integral_plus F f G g : is_integral F f -> is_integral G g -> is_integral (fun t => F t + G t) (fun t => f t + g t).
Proof.
  intros A B. apply (same_integral (fun t => F t + 1 * G t) (fun t => f t + 1 * g t)); [intros t; ring|intros t; ring|].
  apply integral_combined; assumption.
Qed.
Lemma integral_minus F f G g : is_integral F f -> is_integral G g -> is_integral (fun t => F t - G t) (fun t => f t - g t).
Proof.
  intros A B. apply (same_integral (fun t => F t + -1 * G t) (fun t => f t + -1 * g t));
    [intros t; ring|intros t; ring|]. apply integral_combined; assumption.
Qed.
Lemma integral_times F f c : is_integral F f -> is_integral (fun t => c * F t) (fun t => c * f t).
Proof.
  intros A. apply (same_integral (fun t => 0 + c * F t) (fun t => 0 + c * f t)); [intros t; ring|intros t; ring|].
  apply (integral_combined (fun _ => 0) (fun _ => 0)); [apply integral_constant|exact A].
Qed.

(* The library's own integral of what has a continuous derivative. *)
Lemma integral_of_derivative F f :
  (forall t, derivable_pt_lim F t (f t)) -> continuity f -> is_integral F f.
Proof.
  intros D C s t T.
  assert (d : derivable F) by (intros u; exists (f u); apply D).
  assert (E : derive F d = f).
  { apply functional_extensionality. intros u. unfold derive. apply derive_pt_eq_0, D. }
  assert (c : continuity (derive F d)) by (rewrite E; exact C).
  assert (r : Riemann_integrable (derive F d) s t).
  { apply continuity_implies_RiemannInt; [apply T|]. intros u _. apply c. }
  pose proof (FTC_Riemann (mkC1 c) r) as H. cbn [c1 diff0] in H. revert r H. rewrite E.
  intros r H. exists r. symmetry. exact H.
Qed.
Lemma integral_quadratic a v s : is_integral (fun t => v * (t - s) + a * (t - s) ^ 2 / 2) (fun t => v + a * (t - s)).
Proof.
  apply integral_of_derivative.
  - intros t.
    replace (v + a * (t - s)) with (v * (1 - 0) + (a * (INR 2 * (t - s) ^ 1 * (1 - 0))) / 2) by (simpl; field).
    apply derivable_pt_lim_plus.
    + apply derivable_pt_lim_scal. apply derivable_pt_lim_minus; [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
    + apply (derivable_pt_lim_ext (fun t => / 2 * (a * (t - s) ^ 2))); [intros u; field|].
      unfold Rdiv. rewrite Rmult_comm. apply derivable_pt_lim_scal, derivable_pt_lim_scal.
      apply (derivable_pt_lim_comp (fun t => t - s) (fun x => x ^ 2)).
      * apply derivable_pt_lim_minus; [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
      * apply derivable_pt_lim_pow.
  - reg.
Qed.

(* --- growth --------------------------------------------------------------------------------------------- *)
Lemma grows_less F f G g s t : is_integral F f -> is_integral G g -> 0 <= s <= t ->
  (forall u, s < u < t -> f u <= g u) -> F t - F s <= G t - G s.
Proof.
  intros A B T H. destruct (A s t T) as [p ->]. destruct (B s t T) as [q ->]. apply RiemannInt_P19; [apply T|exact H].
Qed.
Lemma grows_at_most F f c s t : is_integral F f -> 0 <= s <= t ->
  (forall u, s < u < t -> f u <= c) -> F t - F s <= c * (t - s).
Proof.
  intros A T H. replace (c * (t - s)) with (c * t + 0 - (c * s + 0)) by ring.
  apply (grows_less F f (fun t => c * t + 0) (fun _ => c)); [exact A|apply integral_linear|exact T|exact H].
Qed.
Lemma grows_at_least F f c s t : is_integral F f -> 0 <= s <= t ->
  (forall u, s < u < t -> c <= f u) -> c * (t - s) <= F t - F s.
Proof.
  intros A T H. replace (c * (t - s)) with (c * t + 0 - (c * s + 0)) by ring.
  apply (grows_less (fun t => c * t + 0) (fun _ => c) F f); [apply integral_linear|exact A|exact T|exact H].
Qed.
(* F' is at most v at s, and grows by at most r from there to t *)
Lemma grows_twice F f f' v r s t : is_integral F f -> is_integral f f' -> 0 <= s <= t -> f s <= v ->
  (forall u, s < u < t -> f' u <= r) -> F t - F s <= v * (t - s) + r * (t - s) ^ 2 / 2.
Proof.
  intros A B T V H.
  replace (v * (t - s) + r * (t - s) ^ 2 / 2)
    with (v * (t - s) + r * (t - s) ^ 2 / 2 - (v * (s - s) + r * (s - s) ^ 2 / 2)) by field.
  apply (grows_less F f (fun t => v * (t - s) + r * (t - s) ^ 2 / 2) (fun t => v + r * (t - s)));
    [exact A|apply integral_quadratic|exact T|].
  intros u U. assert (f u - f s <= r * (u - s)); [|lra].
  apply (grows_at_most f f'); [exact B|lra|]. intros w W. apply H. lra.
Qed.

(* --- bounded, hence continuous -------------------------------------------------------------------------- *)
Lemma step_bounded a b (phi : StepFun a b) : a <= b -> exists M, forall t, a <= t <= b -> Rabs (phi t) <= M.
Proof.
  intros L. destruct phi as [phi [l [lf [O [B [E [N C]]]]]]]. cbn [fe].
  rewrite Rmin_left in B by exact L. rewrite Rmax_right in E by exact L.
  assert (H : forall k, (k <= pred (length l))%nat ->
    exists M, forall t, a <= t <= pos_Rl l k -> Rabs (phi t) <= M).
  { induction k as [|k IH]; intros K.
    - exists (Rabs (phi a)). intros t T. rewrite B in T. replace t with a by lra. lra.
    - destruct IH as [M IH]; [lia|].
      exists (Rmax M (Rmax (Rabs (pos_Rl lf k)) (Rabs (phi (pos_Rl l (S k)))))). intros t T.
      destruct (Rle_lt_dec t (pos_Rl l k)) as [X|X].
      + apply Rle_trans with M; [apply IH; lra|apply Rmax_l].
      + destruct (Rle_lt_or_eq_dec t (pos_Rl l (S k))) as [Y|Y]; [lra| |].
        * rewrite (C k ltac:(lia) t) by (split; assumption).
          apply Rle_trans with (2 := Rmax_r _ _). apply Rmax_l.
        * rewrite Y. apply Rle_trans with (2 := Rmax_r _ _). apply Rmax_r. }
  destruct (H (pred (length l)) (le_n _)) as [M HM]. exists M. rewrite <- E. exact HM.
Qed.
Lemma integrable_bounded f a b : a <= b -> Riemann_integrable f a b -> exists M, forall t, a <= t <= b -> Rabs (f t) <= M.
Proof.
  intros L I. destruct (I (mkposreal 1 Rlt_0_1)) as [phi [psi [H _]]].
  rewrite Rmin_left, Rmax_right in H by exact L.
  destruct (step_bounded a b phi L) as [M HM]. destruct (step_bounded a b psi L) as [N HN].
  exists (M + N). intros t T. specialize (H t T). specialize (HM t T). specialize (HN t T).
  pose proof (Rle_abs (psi t)). pose proof (Rabs_triang (f t - phi t) (phi t)) as G.
  replace (f t - phi t + phi t) with (f t) in G by ring. lra.
Qed.

(* F, continued before 0 *)
Definition from_0 (F : R -> R) (t : R) : R := F (Rmax 0 t).
Definition steady (F : R -> R) : Prop := continuity (from_0 F).

Lemma between x m : Rabs x <= m -> - m <= x <= m.
Proof. unfold Rabs. destruct (Rcase_abs x); lra. Qed.
Lemma clamp_near t u : Rabs (Rmax 0 u - Rmax 0 t) <= Rabs (u - t).
Proof. unfold Rmax, Rabs. repeat destruct Rle_dec; repeat destruct Rcase_abs; lra. Qed.
Lemma integral_steady F f : is_integral F f -> steady F.
Proof.
  intros A t. set (p := Rmax 0 t). assert (P : 0 <= p) by apply Rmax_l.
  destruct (A 0 (p + 1)) as [pr _]; [lra|].
  destruct (integrable_bounded f 0 (p + 1) ltac:(lra) pr) as [M HM].
  assert (M0 : 0 <= M). { apply Rle_trans with (Rabs (f 0)); [apply Rabs_pos|apply HM; lra]. }
  assert (K : forall x y, 0 <= x <= y -> y <= p + 1 -> Rabs (F y - F x) <= M * (y - x)).
  { intros x y X Y. apply Rabs_le. split.
    - replace (- (M * (y - x))) with ((- M) * (y - x)) by ring. apply (grows_at_least F f); [exact A|exact X|].
      intros u U. assert (B := HM u ltac:(lra)). apply between in B. lra.
    - apply (grows_at_most F f); [exact A|exact X|].
      intros u U. assert (B := HM u ltac:(lra)). apply between in B. lra. }
  intros eps E. set (w := Rmin 1 (eps / (M + 1))).
  assert (Q : 0 < eps / (M + 1)) by (apply Rdiv_lt_0_compat; lra).
  exists w. split; [apply Rmin_pos; lra|]. intros u [_ U]. unfold dist in *. cbn in *. unfold R_dist in *.
  unfold from_0. fold p. set (q := Rmax 0 u). assert (Q0 : 0 <= q) by apply Rmax_l.
  pose proof (clamp_near t u) as N. fold p q in N.
  assert (W1 : Rabs (q - p) < 1). { apply Rle_lt_trans with (1 := N). apply Rlt_le_trans with (1 := U). apply Rmin_l. }
  assert (W2 : Rabs (q - p) < eps / (M + 1)).
  { apply Rle_lt_trans with (1 := N). apply Rlt_le_trans with (1 := U). apply Rmin_r. }
  assert (S : (M + 1) * (eps / (M + 1)) = eps) by (field; lra).
  assert (G : Rabs (F q - F p) <= M * Rabs (q - p)).
  { destruct (Rle_lt_dec p q) as [C|C].
    - rewrite (Rabs_pos_eq (q - p)) in * by lra. apply K; lra.
    - rewrite (Rabs_left (q - p)) in * by lra. rewrite Rabs_minus_sym. replace (- (q - p)) with (p - q) by ring.
      apply K; lra. }
  apply Rle_lt_trans with (1 := G). rewrite <- S.
  pose proof (Rabs_pos (q - p)). nra.
Qed.

Lemma from_0_at F t : 0 <= t -> from_0 F t = F t.
Proof. intros T. unfold from_0. rewrite Rmax_right by exact T. reflexivity. Qed.
Lemma steady_lingers F : steady F -> lingers (fun t => 0 < F t).
Proof.
  intros C t T P. destruct (C t (F t) P) as [w [W H]]. exists w. split; [exact W|]. intros u U N.
  destruct (Req_dec t u) as [<-|D]; [exact P|].
  specialize (H u). unfold dist in H. cbn in H. unfold R_dist in H. rewrite !from_0_at in H by assumption.
  assert (K : Rabs (F u - F t) < F t).
  { apply H. split; [split; [exact I|exact D]|]. apply Rabs_def1; lra. }
  apply Rabs_def2 in K. lra.
Qed.

(* --- what lingers --------------------------------------------------------------------------------------- *)
Lemma lingers_same (p q : R -> Prop) : (forall t, p t <-> q t) -> lingers p -> lingers q.
Proof.
  intros E H t T Q. apply E in Q. destruct (H t T Q) as [w [W L]]. exists w. split; [exact W|].
  intros u U N. apply E. apply L; assumption.
Qed.
Lemma lingers_always (p : Prop) : lingers (fun _ => p).
Proof. intros t _ P. exists 1. split; [lra|]. intros _ _ _. exact P. Qed.
Lemma lingers_and p q : lingers p -> lingers q -> lingers (fun t => p t /\ q t).
Proof.
  intros A B t T [P Q]. destruct (A t T P) as [v [V HV]]. destruct (B t T Q) as [w [W HW]].
  exists (Rmin v w). split; [apply Rmin_pos; assumption|]. intros u U N.
  pose proof (Rmin_l v w). pose proof (Rmin_r v w). split; [apply HV|apply HW]; lra.
Qed.
Lemma lingers_or p q : lingers p -> lingers q -> lingers (fun t => p t \/ q t).
Proof.
  intros A B t T [P|P].
  - destruct (A t T P) as [w [W H]]. exists w. split; [exact W|]. intros u U N. left. apply H; assumption.
  - destruct (B t T P) as [w [W H]]. exists w. split; [exact W|]. intros u U N. right. apply H; assumption.
Qed.
Lemma lingers_some {A} (d : A -> Prop) (p : A -> R -> Prop) :
  (forall e, lingers (p e)) -> lingers (fun t => exists e, d e /\ p e t).
Proof.
  intros H t T [e [D P]]. destruct (H e t T P) as [w [W L]]. exists w. split; [exact W|].
  intros u U N. exists e. split; [exact D|apply L; assumption].
Qed.
Lemma lingers_every {A} (l : list A) (d : A -> Prop) (p : A -> R -> Prop) : (forall e, List.In e l) ->
  (forall e, lingers (p e)) -> lingers (fun t => forall e, d e -> p e t).
Proof.
  intros F H. assert (K : forall l, lingers (fun t => forall e, List.In e l -> d e -> p e t)).
  { clear l F. induction l as [|e l IH].
    - apply (lingers_same (fun _ => True)); [|apply lingers_always]. intros t. split; [intros _ e []|trivial].
    - apply (lingers_same (fun t => (d e -> p e t) /\ (forall e, List.In e l -> d e -> p e t))).
      + intros t. split.
        * intros [X Y] e' [<-|I'] D; [apply X, D|apply Y; assumption].
        * intros X. split; [apply X; left; reflexivity|]. intros e' I' D. apply X; [right; exact I'|exact D].
      + apply lingers_and; [|exact IH]. destruct (classic (d e)) as [D|D].
        * apply (lingers_same (p e)); [|apply H]. intros t. tauto.
        * apply (lingers_same (fun _ => True)); [|apply lingers_always]. intros t. tauto. }
  apply (lingers_same (fun t => forall e, List.In e l -> d e -> p e t)); [|apply K].
  intros t. split; [intros X e; apply X, F|intros X e _; apply X].
Qed.

Lemma below_lingers F f c : is_integral F f -> lingers (fun t => c < F t).
Proof.
  intros H. apply (lingers_same (fun t => 0 < F t - c)); [intros t; lra|]. apply steady_lingers.
  apply (integral_steady _ (fun t => f t - 0)), integral_minus; [exact H|apply integral_constant].
Qed.
Lemma behind_lingers F f c : is_integral F f -> lingers (fun t => F t < c).
Proof.
  intros H. apply (lingers_same (fun t => 0 < c - F t)); [intros t; lra|]. apply steady_lingers.
  apply (integral_steady _ (fun t => 0 - f t)), integral_minus; [apply integral_constant|exact H].
Qed.
(* The box moves as its position does and the lanelet stands still, so that those that overlap go on to overlap. *)
Theorem overlaps W : motion W -> forall a l, lingers (occupies W a l).
Proof.
  intros M a l. pose proof (grows W M Place_lon Speed_lon a eq_refl) as A.
  pose proof (grows W M Place_lat Speed_lat a eq_refl) as B.
  unfold occupies. apply lingers_and; [|apply lingers_and; [|apply lingers_and]].
  - destruct (s_from (shape W l)); [apply (below_lingers _ _ _ A)|apply lingers_always].
  - destruct (s_to (shape W l)) as [b|]; [|apply lingers_always].
    apply (lingers_same (fun t => value W Place_lon a t < b + measure W Length a));
      [intros t; lra|apply (behind_lingers _ _ _ A)].
  - apply (below_lingers _ _ _ B).
  - apply (lingers_same (fun t => value W Place_lat a t < d_to (shape W l) + measure W Width a));
      [intros t; lra|apply (behind_lingers _ _ _ B)].
Qed.

(* What lingers goes on for ever, or has a first instant at which it is over. *)
Lemma first_after (p : R -> Prop) s : lingers p -> 0 <= s -> p s ->
  (forall t, s <= t -> p t) \/ exists t, s <= t /\ ~ p t /\ forall u, s <= u < t -> p u.
Proof.
  intros L S P. destruct (classic (forall t, s <= t -> p t)) as [A|A]; [left; exact A|right].
  apply not_all_ex_not in A as [e A]. apply imply_to_and in A as [Ee A].
  set (E := fun t => s <= t <= e /\ forall u, s <= u < t -> p u).
  assert (B : Raxioms.bound E). { exists e. intros t [T _]. apply T. }
  assert (N : exists t, E t). { exists s. split; [lra|]. intros u U. lra. }
  destruct (completeness E B N) as [r [R1 R2]].
  assert (Sr : s <= r). { apply R1. split; [lra|]. intros u U. lra. }
  assert (re : r <= e). { apply R2. intros t [T _]. apply T. }
  assert (H : forall u, s <= u < r -> p u).
  { intros u U. apply NNPP. intros Z. assert (r <= u); [|lra]. apply R2. intros t [T K].
    apply Rnot_lt_le. intros Q. apply Z, K. lra. }
  exists r. split; [exact Sr|split; [|exact H]]. intros Z.
  destruct (L r ltac:(lra) Z) as [w [W K]].
  assert (G : E (Rmin e (r + w / 2))).
  { pose proof (Rmin_l e (r + w / 2)). pose proof (Rmin_r e (r + w / 2)).
    split; [split; [apply Rmin_glb; lra|lra]|]. intros u U.
    destruct (Rlt_le_dec u r) as [X|X]; [apply H; lra|apply K; lra]. }
  apply R1 in G. assert (D : r = e); [|subst r; exact (A Z)].
  revert G. unfold Rmin. destruct (Rle_dec e (r + w / 2)); intros; lra.
Qed.
(* What is at most 0 at s and above 0 at t has been above 0 since an instant at which it was at most 0. *)
Lemma last_before F s t : steady F -> 0 <= s <= t -> F s <= 0 -> 0 < F t ->
  exists r, s <= r < t /\ F r <= 0 /\ forall u, r < u <= t -> 0 < F u.
Proof.
  intros C T A B. pose proof (steady_lingers F C) as L.
  set (E := fun u => s <= u <= t /\ F u <= 0).
  assert (Bd : Raxioms.bound E). { exists t. intros u [U _]. apply U. }
  assert (N : exists u, E u). { exists s. split; [lra|exact A]. }
  destruct (completeness E Bd N) as [r [R1 R2]].
  assert (sr : s <= r). { apply R1. split; [lra|exact A]. }
  assert (rt : r <= t). { apply R2. intros u [U _]. apply U. }
  assert (Z : F r <= 0).
  { apply Rnot_lt_le. intros P. destruct (L r ltac:(lra) P) as [w [W K]].
    assert (r <= r - w / 2); [|lra]. apply R2. intros u [U Q]. apply Rnot_lt_le. intros X.
    assert (0 < F u); [|lra]. apply K; [lra|]. assert (u <= r) by (apply R1; split; assumption). lra. }
  exists r. split; [split; [exact sr|]|split; [exact Z|]].
  - destruct (Rle_lt_or_eq_dec r t rt) as [X|X]; [exact X|]. rewrite X in Z. lra.
  - intros u U. apply Rnot_le_lt. intros Q. assert (u <= r); [|lra]. apply R1. split; [lra|exact Q].
Qed.
