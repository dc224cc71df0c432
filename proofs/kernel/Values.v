(* Values that a claim's own premise demands, put in before it is proved.  NOT TRUSTED: proved.

   `minDanger = 0.6 s -> p` is false only where minDanger is 0.6 s, so it is valid where p is with 0.6 s in place
   of minDanger.  `demands` is a program that reads such values from a claim, `put` puts them in, and the theorem
   `accepted_at` at the end says: what `accepts_at` accepts is valid, in the sense of Meaning.v. *)
From Coq Require Import Reals QArith Qreals String List Bool Lra Classical.
From Roadproof Require Import Meaning Linear Tableau.
Import ListNotations.
Open Scope R_scope.

Definition values := list (string * Q).
Fixpoint value_of (p : string) (vs : values) : option Q :=
  match vs with [] => None | (p', q) :: vs => if String.eqb p' p then Some q else value_of p vs end.

(* --- numbers in place of parameters --------------------------------------------------------------------- *)
Section Put.
  Variable vs : values.
  Fixpoint put_term (x : term) : term :=
    match x with
    | Par p => match value_of p vs with Some q => Num q | None => Par p end
    | Add x y => Add (put_term x) (put_term y)
    | Mul x y => Mul (put_term x) (put_term y)
    | Pow x n => Pow (put_term x) n
    | Div x y => Div (put_term x) (put_term y)
    | Max x y => Max (put_term x) (put_term y)
    | Min x y => Min (put_term x) (put_term y)
    | _ => x
    end.
  Definition put_side (s : side) : side := match s with Fin x => Fin (put_term x) | Inv x => Inv (put_term x) end.
  Fixpoint put (f : formula) : formula :=
    match f with
    | Compare l o r => Compare (put_side l) o (put_side r)
    | Some_ n d f => Some_ n d (put f)
    | Every n d f => Every n d (put f)
    | Not f => Not (put f)
    | And f g => And (put f) (put g)
    | Or f g => Or (put f) (put g)
    | Until f lo hi g => Until (put f) (put_term lo) (option_map put_term hi) (put g)
    | Eventually lo hi f => Eventually (put_term lo) (option_map put_term hi) (put f)
    | Always lo hi f => Always (put_term lo) (option_map put_term hi) (put f)
    | _ => f
    end.

  Variable W : world.
  Hypothesis agree : forall p q, value_of p vs = Some q -> parameter W p = Q2R q.

  Lemma number_put t x : number W t (put_term x) = number W t x.
  Proof.
    induction x; cbn [put_term number]; try congruence.
    destruct (value_of name vs) as [q|] eqn:E; [symmetry; apply agree; assumption|reflexivity].
  Qed.
  Lemma within_put t lo hi u : within W t (put_term lo) (option_map put_term hi) u <-> within W t lo hi u.
  Proof. unfold within. destruct hi; cbn [option_map]; rewrite !number_put; reflexivity. Qed.
  Lemma holds_put named f : forall b t, holds W named b t (put f) <-> holds W named b t f.
  Proof.
    induction f; intros b' t; cbn [put holds]; try tauto.
    - assert (E : forall s, extended_number W t (put_side s) = extended_number W t s).
      { intros [x|x]; cbn [put_side extended_number]; rewrite number_put; reflexivity. }
      rewrite !E. reflexivity.
    - split; intros [e [H1 H2]]; exists e; (split; [exact H1|apply IHf; exact H2]).
    - split; intros H e He; apply IHf, H, He.
    - rewrite IHf. reflexivity.
    - rewrite IHf1, IHf2. reflexivity.
    - rewrite IHf1, IHf2. reflexivity.
    - setoid_rewrite within_put. setoid_rewrite IHf1. setoid_rewrite IHf2. rewrite number_put. reflexivity.
    - setoid_rewrite within_put. setoid_rewrite IHf. reflexivity.
    - setoid_rewrite within_put. setoid_rewrite IHf. reflexivity.
  Qed.
End Put.

(* --- what a claim demands ------------------------------------------------------------------------------- *)
(* Whether p <= q follows where up is true, and q <= p else, from 0 <= v over 1 and p. *)
Definition bounds_it (up : bool) (q : Q) (v : vec) : bool :=
  match v with
  | [a; k] => Qle_bool (a + k * q) 0 && negb (if up then Qle_bool 0 k else Qle_bool k 0)
  | _ => false
  end.
(* Whether that follows from f being true (false) at some time. *)
Fixpoint demands (up : bool) (p : string) (q : Q) (b : bool) (f : formula) : bool :=
  match f with
  | Compare l o r => match timing [p] b l o r with Some (_, v) => bounds_it up q v | None => false end
  | Not f => demands up p q (negb b) f
  | And f g => if b then demands up p q b f || demands up p q b g else demands up p q b f && demands up p q b g
  | Or f g => if b then demands up p q b f && demands up p q b g else demands up p q b f || demands up p q b g
  | Until _ _ _ f | Eventually _ _ f | Some_ _ _ f => b && demands up p q b f
  | Always _ _ f | Every _ _ f => negb b && demands up p q b f
  | _ => false
  end.

Section Demands.
  Variable W : world.
  Variables (up : bool) (p : string) (q : Q).
  Definition bounded : Prop := if up then parameter W p <= Q2R q else Q2R q <= parameter W p.

  Lemma Qle_0 x : Qle_bool x 0 = true -> Q2R x <= 0.
  Proof. intros H. apply Qle_bool_iff, Qle_Rle in H. rewrite Q2R_0 in H. exact H. Qed.
  Lemma bounds_it_sound v r : r O = 1 -> r 1%nat = parameter W p -> 0 <= veval v r ->
    bounds_it up q v = true -> bounded.
  Proof.
    intros R1 RP E H. destruct v as [|a [|k [|]]]; try discriminate. unfold bounds_it in H.
    apply andb_prop in H as [H K]. apply negb_true_iff in K. apply Qle_0 in H.
    rewrite Q2R_plus, Q2R_mult in H. cbn [veval] in E. rewrite R1, RP in E. unfold bounded.
    destruct up.
    - apply Qneg_R in K. nra.
    - assert (0 < Q2R k); [|nra]. apply Rnot_le_lt. intros L.
      rewrite <- Q2R_0 in L. apply Rle_Qle, Qle_bool_iff in L. congruence.
  Qed.
  Lemma demands_sound named f : forall b bound t, demands up p q b f = true ->
    (if b then holds W named bound t f else ~ holds W named bound t f) -> bounded.
  Proof.
    induction f; intros b' bound t H A; cbn [demands] in H; try discriminate.
    - destruct (timing [p] b' l o r) as [[s v]|] eqn:T; [|discriminate].
      set (m := fun n => match n with 0%nat => 1 | _ => parameter W p end).
      assert (G : good [p] W m).
      { split; [reflexivity|]. intros [|[|i]] x E; cbn in E; congruence || (injection E as <-; reflexivity). }
      apply (timing_sound [p] W m t named b' l o r _ G) in T; [|exact A].
      apply (bounds_it_sound v m); try reflexivity; [|exact H].
      unfold chold, choldb in T. cbn [fst snd] in T. destruct s; lra.
    - apply andb_prop in H as [-> H]. destruct A as [e [_ A]]. exact (IHf true _ t H A).
    - apply andb_prop in H as [N H]. destruct b'; [discriminate|].
      apply not_all_ex_not in A as [e A]. apply imply_to_and in A as [_ A]. exact (IHf false _ t H A).
    - apply (IHf (negb b') bound t H). destruct b'; cbn [negb]; [exact A|apply NNPP; exact A].
    - destruct b'.
      + destruct A as [A1 A2]. apply orb_prop in H as [H|H]; [exact (IHf1 true _ t H A1)|exact (IHf2 true _ t H A2)].
      + apply andb_prop in H as [H1 H2].
        apply not_and_or in A as [A|A]; [exact (IHf1 false _ t H1 A)|exact (IHf2 false _ t H2 A)].
    - destruct b'.
      + apply andb_prop in H as [H1 H2].
        destruct A as [A|A]; [exact (IHf1 true _ t H1 A)|exact (IHf2 true _ t H2 A)].
      + apply not_or_and in A as [A1 A2].
        apply orb_prop in H as [H|H]; [exact (IHf1 false _ t H A1)|exact (IHf2 false _ t H A2)].
    - apply andb_prop in H as [-> H]. destruct A as [u [_ [A _]]]. exact (IHf2 true _ u H A).
    - apply andb_prop in H as [-> H]. destruct A as [u [_ A]]. exact (IHf true _ u H A).
    - apply andb_prop in H as [N H]. destruct b'; [discriminate|].
      apply not_all_ex_not in A as [u A]. apply imply_to_and in A as [_ A]. exact (IHf false _ u H A).
  Qed.
End Demands.

(* --- claims --------------------------------------------------------------------------------------------- *)
Definition all_demanded (vs : values) (claim : formula) : bool :=
  forallb (fun x => demands true (fst x) (snd x) false claim && demands false (fst x) (snd x) false claim) vs.
Definition accepts_at ps bounds facts vs claim tr : bool :=
  all_demanded vs claim && accepts ps bounds facts (put vs claim) tr.

Theorem accepted_at ps bounds facts vs claim tr :
  Forall (valid_always bounds) facts -> accepts_at ps bounds facts vs claim tr = true -> valid bounds claim.
Proof.
  intros HL HA W named HB. apply andb_prop in HA as [HD HA]. apply NNPP. intros N. apply N.
  refine (proj1 (holds_put vs W _ named claim _ 0) (accepted ps bounds facts _ tr HL HA W named HB)).
  clear HA. unfold all_demanded in HD. induction vs as [|[p' q'] vs IH]; intros p q E; cbn in E; [discriminate|].
  cbn [forallb fst snd] in HD. apply andb_prop in HD as [HD HV]. apply andb_prop in HD as [D1 D2].
  destruct (String.eqb_spec p' p) as [->|_]; [|exact (IH HV p q E)]. injection E as ->.
  apply Rle_antisym.
  - exact (demands_sound W true p q named claim false _ 0 D1 N).
  - exact (demands_sound W false p q named claim false _ 0 D2 N).
Qed.
