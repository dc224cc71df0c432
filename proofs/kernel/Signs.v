(* Signs of polynomials on intervals.  NOT TRUSTED: proved.

   `above strict p I` is a program that says yes only where the polynomial p, with rational coefficients, is
   positive (or not negative) everywhere in the interval I: it looks at the coefficients of Bernstein's form, or
   of the Taylor expansion where I has no end.  It is complete once I is narrow enough. *)
From Coq Require Import Reals QArith Qreals List Bool Lra Psatz.
Import ListNotations.
Open Scope R_scope.

(* --- rational numbers, kept small ----------------------------------------------------------------------- *)
Definition plus (a b : Q) : Q := Qred (a + b).
Definition minus (a b : Q) : Q := Qred (a - b).
Definition times (a b : Q) : Q := Qred (a * b).
Definition below (a b : Q) : bool := negb (Qle_bool b a).

Lemma red_R q : Q2R (Qred q) = Q2R q. Proof. apply Qeq_eqR, Qred_correct. Qed.
Lemma plus_R a b : Q2R (plus a b) = Q2R a + Q2R b. Proof. unfold plus. rewrite red_R. apply Q2R_plus. Qed.
Lemma minus_R a b : Q2R (minus a b) = Q2R a - Q2R b. Proof. unfold minus. rewrite red_R. apply Q2R_minus. Qed.
Lemma times_R a b : Q2R (times a b) = Q2R a * Q2R b. Proof. unfold times. rewrite red_R. apply Q2R_mult. Qed.
Lemma zero_R : Q2R 0 = 0. Proof. unfold Q2R. simpl. lra. Qed.
Lemma one_R : Q2R 1 = 1. Proof. unfold Q2R. simpl. lra. Qed.
Lemma le_R a b : Qle_bool a b = true -> Q2R a <= Q2R b.
Proof. intros H. apply Qle_Rle, Qle_bool_iff, H. Qed.
Lemma not_le_R a b : Qle_bool a b = false -> Q2R b < Q2R a.
Proof.
  intros H. apply Qlt_Rlt, Qnot_le_lt. intros L. apply Qle_bool_iff in L. congruence.
Qed.
Lemma below_R a b : below a b = true -> Q2R a < Q2R b.
Proof. unfold below. intros H. apply not_le_R, negb_true_iff, H. Qed.

(* --- intervals ------------------------------------------------------------------------------------------ *)
(* from_ is excluded where after_ is true; the end too where its flag is. *)
Record interval := { from_ : Q; after_ : bool; to_ : option (Q * bool) }.
Definition inside (I : interval) (t : R) : Prop :=
  (if after_ I then Q2R (from_ I) < t else Q2R (from_ I) <= t)
  /\ match to_ I with
     | None => True
     | Some (b, before) => if before : bool then t < Q2R b else t <= Q2R b
     end.
Lemma inside_from I t : inside I t -> Q2R (from_ I) <= t.
Proof. intros [H _]. destruct (after_ I); lra. Qed.
Lemma inside_to I t b o : to_ I = Some (b, o) -> inside I t -> t <= Q2R b.
Proof. unfold inside. intros -> [_ H]. destruct o; lra. Qed.

(* --- polynomials, lowest power first -------------------------------------------------------------------- *)
Fixpoint eval (p : list Q) (t : R) : R := match p with [] => 0 | a :: p => Q2R a + t * eval p t end.
Definition with_head (a : Q) (p : list Q) : list Q :=
  match p with [] => if Qeq_bool a 0 then [] else [a] | _ => a :: p end.
Fixpoint padd (p q : list Q) : list Q :=
  match p, q with [], _ => q | _, [] => p | a :: p, b :: q => with_head (plus a b) (padd p q) end.
Definition pscale (c : Q) (p : list Q) : list Q := if Qeq_bool c 0 then [] else map (times c) p.
Definition psub (p q : list Q) : list Q := padd p (pscale (-1) q).
Fixpoint pmul (p q : list Q) : list Q :=
  match p, q with
  | [], _ | _, [] => []
  | [a], _ => pscale a q
  | a :: p, _ => padd (pscale a q) (0%Q :: pmul p q)
  end.
Fixpoint ppow (p : list Q) (n : nat) : list Q := match n with O => [1%Q] | S n => pmul p (ppow p n) end.
(* p(c + t) *)
Fixpoint pshift (c : Q) (p : list Q) : list Q :=
  match p with [] => [] | a :: p => padd [a] (pmul [c; 1%Q] (pshift c p)) end.

Lemma with_head_eval a p t : eval (with_head a p) t = Q2R a + t * eval p t.
Proof.
  destruct p as [|b p]; [|reflexivity]. cbn [with_head].
  destruct (Qeq_bool a 0) eqn:E; simpl; [|reflexivity].
  apply Qeq_bool_iff, Qeq_eqR in E. rewrite E, zero_R. lra.
Qed.
Lemma padd_eval p : forall q t, eval (padd p q) t = eval p t + eval q t.
Proof.
  induction p as [|a p IH]; intros [|b q] t; cbn [padd]; try (simpl; lra).
  rewrite with_head_eval, IH, plus_R. cbn [eval]. ring.
Qed.
Lemma pscale_eval c p t : eval (pscale c p) t = Q2R c * eval p t.
Proof.
  unfold pscale. destruct (Qeq_bool c 0) eqn:E.
  - apply Qeq_bool_iff, Qeq_eqR in E. rewrite E, zero_R. simpl. lra.
  - clear E. induction p as [|a p IH]; [simpl; ring|]. cbn [map eval]. rewrite IH, times_R. ring.
Qed.
Lemma psub_eval p q t : eval (psub p q) t = eval p t - eval q t.
Proof.
  unfold psub. rewrite padd_eval, pscale_eval.
  replace (Q2R (-1)) with (-1) by (unfold Q2R; simpl; lra). lra.
Qed.
Lemma eval_0 p t : eval (0%Q :: p) t = t * eval p t.
Proof. cbn [eval]. rewrite zero_R. ring. Qed.
Lemma pmul_eval p : forall q t, eval (pmul p q) t = eval p t * eval q t.
Proof.
  induction p as [|a p IH]; intros q t; [simpl; lra|].
  destruct q as [|b q]; [destruct p; simpl; lra|].
  destruct p as [|c p].
  - cbn [pmul]. rewrite pscale_eval. simpl. ring.
  - change (pmul (a :: c :: p) (b :: q)) with (padd (pscale a (b :: q)) (0%Q :: pmul (c :: p) (b :: q))).
    rewrite padd_eval, pscale_eval, eval_0, IH. cbn [eval]. ring.
Qed.
Lemma ppow_eval p n t : eval (ppow p n) t = pow (eval p t) n.
Proof.
  induction n as [|n IH]; [simpl; rewrite one_R; lra|]. cbn [ppow pow]. rewrite pmul_eval, IH. reflexivity.
Qed.
Lemma pshift_eval c p t : eval (pshift c p) t = eval p (Q2R c + t).
Proof.
  induction p as [|a p IH]; [reflexivity|]. cbn [pshift]. rewrite padd_eval, pmul_eval, IH.
  simpl. rewrite one_R. ring.
Qed.

(* --- forms in u and v: the coefficients of u^j v^(n-j) -------------------------------------------------- *)
Fixpoint form (l : list Q) (u v : R) : R :=
  match l with [] => 0 | a :: l => Q2R a * v ^ List.length l + u * form l u v end.
Fixpoint fadd (l m : list Q) : list Q :=
  match l, m with a :: l, b :: m => plus a b :: fadd l m | _, _ => [] end.
Definition fscale (c : Q) (l : list Q) : list Q := map (times c) l.

Lemma fadd_length l : forall m, List.length l = List.length m -> List.length (fadd l m) = List.length l.
Proof. induction l as [|a l IH]; intros [|b m] H; simpl in *; try discriminate; auto. Qed.
Lemma fadd_form l : forall m u v, List.length l = List.length m -> form (fadd l m) u v = form l u v + form m u v.
Proof.
  induction l as [|a l IH]; intros [|b m] u v H; simpl in *; try discriminate; [lra|].
  injection H as H. rewrite IH, plus_R, (fadd_length l m H) by assumption. rewrite <- H. ring.
Qed.
Lemma fscale_form c l u v : form (fscale c l) u v = Q2R c * form l u v.
Proof.
  unfold fscale. induction l as [|a l IH]; cbn [map form]; [ring|]. rewrite map_length, IH, times_R. ring.
Qed.
Lemma form_0 l u v : form (0%Q :: l) u v = u * form l u v.
Proof. simpl. rewrite zero_R. lra. Qed.
Lemma form_end l u v : form (l ++ [0%Q]) u v = v * form l u v.
Proof.
  induction l as [|a l IH]; simpl; [rewrite zero_R; lra|]. rewrite IH, app_length. simpl.
  replace (List.length l + 1)%nat with (S (List.length l)) by (rewrite Nat.add_comm; reflexivity). simpl. ring.
Qed.

(* ((u + v) / w)^n, which is 1 where u + v = w *)
Fixpoint ones (w : Q) (n : nat) : list Q :=
  match n with O => [1%Q] | S n => let l := ones w n in fscale (/ w) (fadd (0%Q :: l) (l ++ [0%Q])) end.
(* A polynomial of u as a form of u and v, which is the same where u + v = w. *)
Fixpoint bernstein (w : Q) (p : list Q) : list Q :=
  match p with
  | [] => []
  | a :: p => let l := bernstein w p in fadd (fscale a (ones w (List.length l))) (0%Q :: l)
  end.

Lemma cons_length (a : Q) l : List.length (a :: l) = S (List.length l). Proof. reflexivity. Qed.
Lemma ends_alike (l : list Q) : List.length (0%Q :: l) = List.length (l ++ [0%Q]).
Proof. rewrite app_length, cons_length, Nat.add_comm. reflexivity. Qed.
Lemma fscale_length c l : List.length (fscale c l) = List.length l.
Proof. apply map_length. Qed.
Lemma ones_length w n : List.length (ones w n) = S n.
Proof.
  induction n as [|n IH]; [reflexivity|]. cbn [ones].
  rewrite fscale_length, fadd_length, cons_length, IH by apply ends_alike. reflexivity.
Qed.
Lemma ones_form w n u v : Q2R w <> 0 -> u + v = Q2R w -> form (ones w n) u v = 1.
Proof.
  intros N E. induction n as [|n IH]; [cbn; rewrite one_R; ring|]. cbn [ones].
  rewrite fscale_form, fadd_form, form_0, form_end, IH by apply ends_alike.
  rewrite Q2R_inv.
  - replace (u * 1 + v * 1) with (Q2R w) by lra. apply Rinv_l. exact N.
  - intros H. apply N. rewrite (Qeq_eqR _ _ H). apply zero_R.
Qed.
Lemma bernstein_form w p u v : Q2R w <> 0 -> u + v = Q2R w -> form (bernstein w p) u v = eval p u.
Proof.
  intros N E. induction p as [|a p IH]; [reflexivity|]. cbn [bernstein eval].
  assert (L : forall l, List.length (fscale a (ones w (List.length l))) = List.length (0%Q :: l)).
  { intros l. rewrite fscale_length, ones_length. reflexivity. }
  rewrite fadd_form by apply L. rewrite fscale_form, form_0, IH, (ones_form w _ u v N E). ring.
Qed.
Lemma eval_form p u : form p u 1 = eval p u.
Proof. induction p as [|a p IH]; simpl; [reflexivity|]. rewrite IH, pow1. ring. Qed.

Definition none_below_0 (l : list Q) : bool := forallb (Qle_bool 0) l.
Definition one_above_0 (l : list Q) : bool := existsb (below 0) l.

Lemma form_not_negative l u v : 0 <= u -> 0 <= v -> none_below_0 l = true -> 0 <= form l u v.
Proof.
  intros U V. induction l as [|a l IH]; simpl; intros H; [lra|]. apply andb_prop in H as [A H].
  apply le_R in A. rewrite zero_R in A. specialize (IH H).
  assert (0 <= v ^ List.length l) by (apply pow_le; exact V). nra.
Qed.
Lemma form_positive l u v :
  0 < u -> 0 < v -> none_below_0 l = true -> one_above_0 l = true -> 0 < form l u v.
Proof.
  intros U V. induction l as [|a l IH]; simpl; intros H E; [discriminate|]. apply andb_prop in H as [A H].
  pose proof (form_not_negative l u v (Rlt_le _ _ U) (Rlt_le _ _ V) H) as F.
  apply le_R in A. rewrite zero_R in A. assert (P : 0 < v ^ List.length l) by (apply pow_lt; exact V).
  apply orb_prop in E as [E|E].
  - apply below_R in E. rewrite zero_R in E. assert (0 < Q2R a * v ^ List.length l) by (apply Rmult_lt_0_compat; assumption). nra.
  - specialize (IH H E). assert (0 < u * form l u v) by (apply Rmult_lt_0_compat; assumption). nra.
Qed.
Lemma form_first l u v :
  0 <= u -> 0 < v -> none_below_0 l = true -> below 0 (hd 0%Q l) = true -> 0 < form l u v.
Proof.
  intros U V. destruct l as [|a l]; simpl; intros H E; [discriminate|]. apply andb_prop in H as [_ H].
  pose proof (form_not_negative l u v U (Rlt_le _ _ V) H) as F.
  apply below_R in E. rewrite zero_R in E. assert (P : 0 < v ^ List.length l) by (apply pow_lt; exact V).
  assert (0 < Q2R a * v ^ List.length l) by (apply Rmult_lt_0_compat; assumption). nra.
Qed.
Lemma form_last l u v :
  0 < u -> 0 <= v -> none_below_0 l = true -> below 0 (last l 0%Q) = true -> 0 < form l u v.
Proof.
  intros U V. induction l as [|a l IH]; intros H E; [discriminate|]. simpl in H. apply andb_prop in H as [A H].
  apply le_R in A. rewrite zero_R in A. destruct l as [|b l].
  - simpl in *. apply below_R in E. rewrite zero_R in E. lra.
  - specialize (IH H E). change (form (a :: b :: l) u v) with
      (Q2R a * v ^ List.length (b :: l) + u * form (b :: l) u v).
    assert (0 <= v ^ List.length (b :: l)) by (apply pow_le; exact V).
    assert (0 < u * form (b :: l) u v) by (apply Rmult_lt_0_compat; assumption). nra.
Qed.

(* --- signs ---------------------------------------------------------------------------------------------- *)
Definition above (strict : bool) (p : list Q) (I : interval) : bool :=
  let p := pshift (from_ I) p in
  match to_ I with
  | None =>
      none_below_0 p && (negb strict || (one_above_0 p && (after_ I || below 0 (hd 0%Q p))))
  | Some (b, before) =>
      if Qle_bool b (from_ I) then (if strict then below 0 (hd 0%Q p) else Qle_bool 0 (hd 0%Q p))
      else
        let l := bernstein (minus b (from_ I)) p in
        none_below_0 l
        && (negb strict || (one_above_0 l && (after_ I || below 0 (hd 0%Q l)) && (before || below 0 (last l 0%Q))))
  end.
Definition sign_ok (strict : bool) (x : R) : Prop := if strict then 0 < x else 0 <= x.

Lemma eval_at_0 p : eval p 0 = Q2R (hd 0%Q p).
Proof. destruct p; simpl; [symmetry; apply zero_R|lra]. Qed.

Theorem above_right strict p I t : above strict p I = true -> inside I t -> sign_ok strict (eval p t).
Proof.
  unfold above. intros H T. set (c := from_ I) in *. pose proof (inside_from I t T) as B. fold c in B.
  replace t with (Q2R c + (t - Q2R c)) by lra. rewrite <- pshift_eval. set (q := pshift c p) in *.
  set (u := t - Q2R c). assert (U : 0 <= u) by (unfold u; lra).
  destruct (to_ I) as [[b before]|] eqn:E.
  - pose proof (inside_to I t b before E T) as B2.
    destruct (Qle_bool b c) eqn:L.
    + apply le_R in L. assert (Z : u = 0) by (unfold u; lra). rewrite Z, eval_at_0.
      destruct strict; unfold sign_ok; [apply below_R in H|apply le_R in H]; rewrite zero_R in H; exact H.
    + apply not_le_R in L. set (w := minus b c) in *.
      assert (W : Q2R w = Q2R b - Q2R c) by apply minus_R.
      set (v := Q2R b - t). assert (V : 0 <= v) by (unfold v; lra).
      rewrite <- (bernstein_form w q u v) by (rewrite W; unfold u, v; lra).
      apply andb_prop in H as [N H]. destruct strict; unfold sign_ok; [|apply form_not_negative; assumption].
      simpl in H. apply andb_prop in H as [H H2]. apply andb_prop in H as [O H1].
      destruct (Rle_lt_or_eq_dec 0 u U) as [U'|U'].
      * destruct (Rle_lt_or_eq_dec 0 v V) as [V'|V']; [apply form_positive; assumption|].
        apply form_last; try assumption. apply orb_prop in H2 as [->|H2]; [|exact H2].
        destruct T as [_ T]. rewrite E in T. unfold v in V'. lra.
      * apply form_first; try assumption; [unfold v, u in *; lra|].
        apply orb_prop in H1 as [A|H1]; [|exact H1]. destruct T as [T _]. rewrite A in T. unfold u, c in *. lra.
  - rewrite <- eval_form. apply andb_prop in H as [N H].
    destruct strict; unfold sign_ok; [|apply form_not_negative; try assumption; lra].
    simpl in H. apply andb_prop in H as [O H1].
    destruct (Rle_lt_or_eq_dec 0 u U) as [U'|U']; [apply form_positive; try assumption; lra|].
    apply form_first; try assumption; [lra|].
    apply orb_prop in H1 as [A|H1]; [|exact H1]. destruct T as [T _]. rewrite A in T. unfold u, c in *. lra.
Qed.
