(* Linear arithmetic over moments.  NOT TRUSTED: proved.

   Moments and parameters are numbered; a linear expression over them is the list of its coefficients, that of
   the constant 1 first.  A set of constraints is shown to be impossible by multipliers whose sum is absurd
   (Farkas): `farkas` computes the sum, and `farkas_sound` says that it is right. *)
From Coq Require Import Reals QArith Qreals List Bool Arith Lia Lra.
Import ListNotations.
Open Scope R_scope.

(* --- linear expressions over time: coefficients of 1, the parameters, the named times ------------- *)
Definition vec := list Q.
Fixpoint veval (v : vec) (r : nat -> R) : R :=
  match v with [] => 0 | q :: v => Q2R q * r O + veval v (fun n => r (S n)) end.
Fixpoint vadd (u v : vec) : vec :=
  match u, v with [], v => v | u, [] => u | p :: u, q :: v => Qred (p + q) :: vadd u v end.
Definition vscale (k : Q) (v : vec) : vec := map (fun q => Qred (k * q)) v.
Definition vsub (u v : vec) : vec := vadd u (vscale (-1 # 1) v).
Fixpoint unit (n : nat) : vec := match n with O => [1%Q] | S n => 0%Q :: unit n end.

Lemma veval_add u : forall v r, veval (vadd u v) r = veval u r + veval v r.
Proof.
  induction u as [|p u IH]; intros [|q v] r; cbn [vadd veval]; try lra.
  rewrite IH, (Qeq_eqR _ _ (Qred_correct (p + q))), Q2R_plus. lra.
Qed.
Lemma veval_scale k v : forall r, veval (vscale k v) r = Q2R k * veval v r.
Proof.
  induction v as [|q v IH]; intros r; cbn [vscale map veval]; [lra|].
  unfold vscale in IH. rewrite IH, (Qeq_eqR _ _ (Qred_correct (k * q))), Q2R_mult. lra.
Qed.
Lemma Q2R_m1 : Q2R (-1 # 1) = -1. Proof. unfold Q2R; simpl; lra. Qed.
Lemma Q2R_1 : Q2R 1 = 1. Proof. unfold Q2R; simpl; lra. Qed.
Lemma Q2R_0 : Q2R 0 = 0. Proof. unfold Q2R; simpl; lra. Qed.
Lemma veval_sub u v r : veval (vsub u v) r = veval u r - veval v r.
Proof. unfold vsub. rewrite veval_add, veval_scale, Q2R_m1. lra. Qed.
Lemma veval_unit n : forall r, veval (unit n) r = r n.
Proof. induction n; intros r; simpl; rewrite ?IHn, ?Q2R_1, ?Q2R_0; lra. Qed.
Lemma veval_agree v : forall r s, (forall n, (n < length v)%nat -> r n = s n) -> veval v r = veval v s.
Proof.
  induction v as [|q v IH]; intros r s H; simpl; [reflexivity|].
  rewrite (H 0%nat) by (simpl; lia). f_equal. apply IH. intros n L. apply H. simpl. lia.
Qed.

(* --- constraints, and sums of them that contradict (Farkas) ---------------------------------------- *)
Definition con := (bool * vec)%type.                       (* 0 < v where true, 0 <= v where false *)
Definition choldb (b : bool) (x : R) : Prop := if b then 0 < x else 0 <= x.
Definition chold (r : nat -> R) (c : con) : Prop := choldb (fst c) (veval (snd c) r).
Definition get {A} (i : nat) (l : list A) : option A :=
  if Nat.ltb i (length l) then nth_error l (length l - S i) else None.
Lemma get_in {A} i (l : list A) x : get i l = Some x -> In x l.
Proof. unfold get. destruct (Nat.ltb _ _); [apply nth_error_In|discriminate]. Qed.

Definition wit := list (nat * Q).
Fixpoint combine_cons (C : list con) (w : wit) : option con :=
  match w with
  | [] => Some (false, [])
  | (i, q) :: w =>
      match get i C, combine_cons C w with
      | Some (s, v), Some (s', u) =>
          if Qle_bool 0 q then Some ((s && negb (Qeq_bool q 0)) || s', vadd (vscale q v) u) else None
      | _, _ => None
      end
  end.
Definition zero (v : vec) : bool := forallb (fun q => Qeq_bool q 0) v.
Definition absurd_con (c : con) : bool :=
  match snd c with
  | [] => fst c
  | k :: v => zero v && (if fst c then Qle_bool k 0 else negb (Qle_bool 0 k))
  end.
Definition farkas (C : list con) (w : wit) : bool :=
  match combine_cons C w with Some c => absurd_con c | None => false end.

Lemma Qle_R q : Qle_bool 0 q = true -> 0 <= Q2R q.
Proof. intros H. apply Qle_bool_iff in H. apply Qle_Rle in H. rewrite Q2R_0 in H. lra. Qed.
Lemma Qle_R' q : Qle_bool q 0 = true -> Q2R q <= 0.
Proof. intros H. apply Qle_bool_iff in H. apply Qle_Rle in H. rewrite Q2R_0 in H. lra. Qed.
Lemma Qeq_R q : Qeq_bool q 0 = true -> Q2R q = 0.
Proof. intros H. apply Qeq_bool_iff in H. apply Qeq_eqR in H. rewrite Q2R_0 in H. exact H. Qed.
Lemma Qpos_R q : Qle_bool 0 q = true -> Qeq_bool q 0 = false -> 0 < Q2R q.
Proof.
  intros H E. apply Qle_R in H. destruct (Req_dec (Q2R q) 0) as [Z|]; [|lra].
  rewrite <- Q2R_0 in Z. apply eqR_Qeq in Z. apply Qeq_bool_iff in Z. congruence.
Qed.
Lemma Qneg_R q : Qle_bool 0 q = false -> Q2R q < 0.
Proof.
  intros H. destruct (Rlt_dec (Q2R q) 0) as [|N]; [assumption|].
  assert (Q2R 0 <= Q2R q) by (rewrite Q2R_0; lra).
  apply Rle_Qle in H0. apply Qle_bool_iff in H0. congruence.
Qed.
Lemma zero_eval v : forall r, zero v = true -> veval v r = 0.
Proof.
  induction v as [|q v IH]; intros r H; simpl in *; [reflexivity|].
  apply andb_prop in H as [H1 H2]. rewrite (Qeq_R _ H1), (IH _ H2). lra.
Qed.
Lemma combine_sound C r w : (forall c, In c C -> chold r c) ->
  forall c, combine_cons C w = Some c -> chold r c.
Proof.
  intros HC. induction w as [|[i q] w IH]; intros c H; simpl in H.
  - injection H as <-. unfold chold; simpl. lra.
  - destruct (get i C) as [[s v]|] eqn:G; [|discriminate].
    destruct (combine_cons C w) as [[s' u]|]; [|discriminate].
    destruct (Qle_bool 0 q) eqn:L; [|discriminate]. injection H as <-.
    specialize (IH _ eq_refl). apply get_in in G. apply HC in G.
    unfold chold, choldb in *; simpl in *. rewrite veval_add, veval_scale.
    pose proof (Qle_R _ L) as P.
    destruct (Qeq_bool q 0) eqn:Z; simpl.
    + rewrite (Qeq_R _ Z). rewrite andb_false_r. simpl. destruct s'; lra.
    + pose proof (Qpos_R _ L Z). rewrite andb_true_r.
      destruct s; simpl.
      * pose proof (Rmult_lt_0_compat _ _ H G). destruct s'; lra.
      * pose proof (Rmult_le_pos _ _ P G). destruct s'; lra.
Qed.
Lemma farkas_sound C r w : r O = 1 -> (forall c, In c C -> chold r c) -> farkas C w = true -> False.
Proof.
  intros R1 HC H. unfold farkas in H. destruct (combine_cons C w) as [[s v]|] eqn:E; [|discriminate].
  apply (combine_sound C r w HC) in E. unfold chold, choldb, absurd_con in *; simpl in *.
  destruct v as [|k v]; simpl in *; [subst; lra|].
  apply andb_prop in H as [Z H]. rewrite R1, (zero_eval _ _ Z) in E.
  destruct s.
  - apply Qle_R' in H. lra.
  - apply negb_true_iff, Qneg_R in H. lra.
Qed.
(* C entails 0 <= v; 0 < v *)
Definition entails C v w := farkas ((true, vscale (-1 # 1) v) :: C) w.
Definition entails_lt C v w := farkas ((false, vscale (-1 # 1) v) :: C) w.
Lemma entails_sound C r v w : r O = 1 -> (forall c, In c C -> chold r c) ->
  entails C v w = true -> 0 <= veval v r.
Proof.
  intros R1 HC H. destruct (Rle_dec 0 (veval v r)) as [|N]; [assumption|exfalso].
  eapply farkas_sound; [exact R1| |exact H]. intros c [<-|I]; [|auto].
  unfold chold; simpl. rewrite veval_scale, Q2R_m1. lra.
Qed.
Lemma entails_lt_sound C r v w : r O = 1 -> (forall c, In c C -> chold r c) ->
  entails_lt C v w = true -> 0 < veval v r.
Proof.
  intros R1 HC H. destruct (Rlt_dec 0 (veval v r)) as [|N]; [assumption|exfalso].
  eapply farkas_sound; [exact R1| |exact H]. intros c [<-|I]; [|auto].
  unfold chold; simpl. rewrite veval_scale, Q2R_m1. lra.
Qed.
