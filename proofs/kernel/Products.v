(* Facts about one instant, by products of what is known.  NOT TRUSTED: proved.

   A fact about one instant is shown as a claim is: it is taken to be false and taken apart, maxima by cases,
   quotients as numbers q with q times divisor = numerator; then comparisons are polynomials that are above or
   at least 0, and products of these with multipliers add up to something absurd (Positivstellensatz).
   `settles` is a program that checks this, and the theorem `settled` says that it is right.  Sums of products
   are computed by Coq's own library (micromega), which has them proved. *)
From Coq Require Import Reals QArith Qreals String List Bool Arith Lia Lra Classical.
From Coq.micromega Require Import OrderedRing RingMicromega EnvRing RMicromega Refl.
From Roadproof Require Import Meaning Tableau.
Import ListNotations.
Open Scope R_scope.

(* Numbers are reduced at each step: denominators of sums would else grow with each summand. *)
Definition plus_q (x y : Q) : Q := Qred (x + y).
Definition minus_q (x y : Q) : Q := Qred (x - y).
Definition times_q (x y : Q) : Q := Qred (x * y).
Lemma Q2R_red x : Q2R (Qred x) = Q2R x. Proof. apply Qeq_eqR, Qred_correct. Qed.
Lemma reduced_q :
  SORaddon 0 1 Rplus Rmult Rminus Ropp (@eq R) Rle 0%Q 1%Q plus_q times_q minus_q Qopp Qeq_bool Qle_bool Q2R N.to_nat pow.
Proof.
  pose proof QSORaddon as [[Z O P S M N E] power unequal below]. constructor; try assumption.
  constructor; try assumption; intros; unfold plus_q, minus_q, times_q; rewrite Q2R_red; auto.
Qed.

Definition poly := PExpr Q.
Definition normal : poly -> Pol Q := norm 0%Q 1%Q plus_q times_q minus_q Qopp Qeq_bool.
Definition constraint := NFormula Q.
Definition above (p : poly) : constraint := (normal p, Strict).
Definition at_least (p : poly) : constraint := (normal p, NonStrict).
Definition zero (p : poly) : constraint := (normal p, Equal).

(* What polynomials and sums are made of, as they are printed; the last constraint is number 0. *)
Definition c_ (z : Z) (n : positive) : poly := PEc (Qmake z n).
Definition x_ (n : positive) : poly := PEX n.
Definition add_ (p r : poly) : poly := PEadd p r.
Definition mul_ (p r : poly) : poly := PEmul p r.
Definition given_ (i : nat) : Psatz Q := PsatzIn Q i.
Definition number_ (z : Z) (n : positive) : Psatz Q := PsatzC (Qmake z n).
Definition square_ (p : poly) : Psatz Q := PsatzSquare (normal p).
Definition times_ (p : poly) (w : Psatz Q) : Psatz Q := PsatzMulC (normal p) w.
Definition product_ (w v : Psatz Q) : Psatz Q := PsatzMulE w v.
Definition sum_ (w v : Psatz Q) : Psatz Q := PsatzAdd w v.

Inductive reason :=
| Absurd (w : Psatz Q)                                     (* constraints that contradict *)
| Untrue (i : nat)                                         (* true is false, or false is true *)
| Opposed (i j : nat)                                      (* the same is true and false *)
| Both (i : nat) (t : reason)                              (* not; both of a conjunction *)
| Either (i : nat) (t1 t2 : reason)                        (* one of a disjunction *)
| Plain (i : nat) (t : reason)                             (* a comparison of inverses, without them *)
| Reads (i : nat) (t : reason)                             (* a comparison as a constraint *)
| Sized (n : size) (a : vehicle) (t : reason)              (* sizes are above zero *)
| Largest (x y : term) (t1 t2 : reason)                    (* max is y, or x *)
| Smallest (x y : term) (t1 t2 : reason)                   (* min is x, or y *)
| Over (x y : term) (up : bool) (w : Psatz Q) (t : reason) (* a quotient by what is above 0, or below *)
| Sign (p : poly) (t1 t2 : reason).                        (* 0 <= p, or p < 0 *)

(* Terms that are read as variables of polynomials, the last in front. *)
Definition table := list (term * poly).
Fixpoint look (T : table) (x : term) : option poly :=
  match T with [] => None | (y, p) :: T => if term_dec x y then Some p else look T x end.
Definition two {A B} (f : A -> A -> B) (x y : option A) : option B :=
  match x, y with Some x, Some y => Some (f x y) | _, _ => None end.
Fixpoint polynomial (T : table) (x : term) : option poly :=
  match look T x with
  | Some p => Some p
  | None =>
      match x with
      | Num q => Some (PEc q)
      | Add x y => two PEadd (polynomial T x) (polynomial T y)
      | Mul x y => two PEmul (polynomial T x) (polynomial T y)
      | Pow x n => option_map (fun p => PEpow p (N.of_nat n)) (polynomial T x)
      | Div x (Num q) => if Qeq_bool q 0%Q then None else option_map (PEmul (PEc (/ q)%Q)) (polynomial T x)
      | _ => None
      end
  end.
Definition reading (T : table) (b : bool) (f : formula) : option constraint :=
  match f with
  | Compare (Fin x) o (Fin y) =>
      match polynomial T x, polynomial T y with
      | Some p, Some q =>
          Some match o, b with
               | LT, true | GE, false => above (PEsub q p)
               | LE, true | GT, false => at_least (PEsub q p)
               | GT, true | LE, false => above (PEsub p q)
               | GE, true | LT, false => at_least (PEsub p q)
               end
      | _, _ => None
      end
  | _ => None
  end.

(* Comparisons of inverses: where 1/0 is infinite. *)
Definition inverse_of (x : term) : term := Div (Num 1) x.
Definition is_zero (x : term) : formula :=
  And (Compare (Fin (Num 0)) LE (Fin x)) (Compare (Fin x) LE (Fin (Num 0))).
Definition lower (o : comparison) (a b : side) : formula :=
  match a, b with
  | Fin x, Fin y => Compare a o b
  | Fin x, Inv y => Or (is_zero y) (Compare (Fin x) o (Fin (inverse_of y)))
  | Inv x, Fin y => And (Not (is_zero x)) (Compare (Fin (inverse_of x)) o (Fin y))
  | Inv x, Inv y =>
      match o with
      | LE => Or (is_zero y) (And (Not (is_zero x)) (Compare (Fin (inverse_of x)) o (Fin (inverse_of y))))
      | _ => And (Not (is_zero x)) (Or (is_zero y) (Compare (Fin (inverse_of x)) o (Fin (inverse_of y))))
      end
  end.
Definition plain (f : formula) : formula :=
  match f with
  | Compare a LT b => lower LT a b | Compare a LE b => lower LE a b
  | Compare a GT b => lower LT b a | Compare a GE b => lower LE b a
  | _ => f
  end.

Definition fact := (bool * formula)%type.
Definition contradicts : list constraint -> Psatz Q -> bool :=
  check_normalised_formulas 0%Q 1%Q plus_q times_q Qeq_bool Qle_bool.
Definition refutes (C : list constraint) (c : constraint) (w : Psatz Q) : bool := contradicts (c :: C) w.
Fixpoint check (T : table) (G : list fact) (C : list constraint) (tr : reason) : bool :=
  match tr with
  | Absurd w => contradicts C w
  | Untrue i => match nth_error G i with Some (b, Truth b') => xorb b b' | _ => false end
  | Opposed i j =>
      match nth_error G i, nth_error G j with Some (true, f), Some (false, g) => same f g | _, _ => false end
  | Both i t =>
      match nth_error G i with
      | Some (b, Not f) => check T ((negb b, f) :: G) C t
      | Some (true, And f g) => check T ((true, g) :: (true, f) :: G) C t
      | Some (false, Or f g) => check T ((false, g) :: (false, f) :: G) C t
      | _ => false
      end
  | Either i t1 t2 =>
      match nth_error G i with
      | Some (true, Or f g) => check T ((true, f) :: G) C t1 && check T ((true, g) :: G) C t2
      | Some (false, And f g) => check T ((false, f) :: G) C t1 && check T ((false, g) :: G) C t2
      | _ => false
      end
  | Plain i t => match nth_error G i with Some (b, f) => check T ((b, plain f) :: G) C t | None => false end
  | Reads i t =>
      match nth_error G i with
      | Some (b, f) => match reading T b f with Some c => check T G (c :: C) t | None => false end
      | None => false
      end
  | Sized n a t =>
      match polynomial T (Siz n a) with Some p => check T G (above p :: C) t | None => false end
  | Largest x y t1 t2 =>
      match polynomial T x, polynomial T y with
      | Some p, Some q =>
          check ((Max x y, q) :: T) G (at_least (PEsub q p) :: C) t1
          && check ((Max x y, p) :: T) G (above (PEsub p q) :: C) t2
      | _, _ => false
      end
  | Smallest x y t1 t2 =>
      match polynomial T x, polynomial T y with
      | Some p, Some q =>
          check ((Min x y, p) :: T) G (at_least (PEsub q p) :: C) t1
          && check ((Min x y, q) :: T) G (above (PEsub p q) :: C) t2
      | _, _ => false
      end
  | Over x y up w t =>
      match polynomial T x, polynomial T y, polynomial T (Div x y) with
      | Some p, Some q, Some r =>
          refutes C (at_least (if up then PEopp q else q)) w && check T G (zero (PEsub (PEmul r q) p) :: C) t
      | _, _, _ => false
      end
  | Sign p t1 t2 => check T G (at_least p :: C) t1 && check T G (above (PEopp p) :: C) t2
  end.

Section Sound.
  Variable W : world.
  Variable named : string -> element W.
  Variable t : R.
  Notation says f := (holds W named (unbound W) t f).
  Variable env : PolEnv R.
  Notation of p := (QReval_expr env p).
  Lemma of_sub p q : of (PEsub p q) = of p - of q. Proof. reflexivity. Qed.
  Lemma of_mul p q : of (PEmul p q) = of p * of q. Proof. reflexivity. Qed.
  Lemma of_opp p : of (PEopp p) = - of p. Proof. reflexivity. Qed.

  Definition true_of (f : fact) : Prop := if fst f then says (snd f) else ~ says (snd f).
  Definition agrees (T : table) : Prop := forall x p, In (x, p) T -> number W t x = of p.
  Definition keeps (C : list constraint) : Prop := forall c, In c C -> Qeval_nformula env c.

  Lemma of_normal p : of p = eval_pol Rplus Rmult Q2R env (normal p).
  Proof. exact (eval_pol_norm Rsor reduced_q env p). Qed.
  Lemma above_means p : Qeval_nformula env (above p) <-> 0 < of p.
  Proof. rewrite of_normal. reflexivity. Qed.
  Lemma at_least_means p : Qeval_nformula env (at_least p) <-> 0 <= of p.
  Proof. rewrite of_normal. reflexivity. Qed.
  Lemma zero_means p : Qeval_nformula env (zero p) <-> of p = 0.
  Proof. rewrite of_normal. reflexivity. Qed.
  Lemma absurd C w : keeps C -> contradicts C w = true -> False.
  Proof.
    intros H K. pose proof (checker_nf_sound Rsor reduced_q C w K env) as S. apply make_conj_impl in S; [exact S|].
    clear K S. induction C as [|c C IH]; [exact I|]. apply make_conj_cons. split.
    - apply H. left. reflexivity.
    - apply IH. intros d D. apply H. right. exact D.
  Qed.
  Lemma keeps_cons c C : Qeval_nformula env c -> keeps C -> keeps (c :: C).
  Proof. intros H K d [<-|I]; [exact H|apply K, I]. Qed.
  Lemma agrees_cons x p T : number W t x = of p -> agrees T -> agrees ((x, p) :: T).
  Proof. intros H K y q [E|I]; [injection E as <- <-; exact H|apply K, I]. Qed.

  Lemma look_in T x p : look T x = Some p -> In (x, p) T.
  Proof.
    induction T as [|[y q] T IH]; simpl; [discriminate|].
    destruct (term_dec x y) as [<-|]; [intros [= <-]; left; reflexivity|intros H; right; apply IH, H].
  Qed.
  Lemma polynomial_means T x : agrees T -> forall p, polynomial T x = Some p -> number W t x = of p.
  Proof.
    intros A. induction x; intros p H; cbn [polynomial] in H;
      match type of H with context [look T ?y] => destruct (look T y) as [p'|] eqn:L end;
      try (injection H as <-; exact (A _ _ (look_in _ _ _ L))); try discriminate.
    - injection H as <-. reflexivity.
    - destruct (polynomial T x1), (polynomial T x2); try discriminate. injection H as <-.
      cbn [number]. rewrite (IHx1 _ eq_refl), (IHx2 _ eq_refl). reflexivity.
    - destruct (polynomial T x1), (polynomial T x2); try discriminate. injection H as <-.
      cbn [number]. rewrite (IHx1 _ eq_refl), (IHx2 _ eq_refl). reflexivity.
    - destruct (polynomial T x); try discriminate. injection H as <-.
      cbn [number]. rewrite (IHx _ eq_refl).
      change (of p0 ^ n = of p0 ^ N.to_nat (N.of_nat n)). rewrite Nnat.Nat2N.id. reflexivity.
    - destruct x2; try discriminate. destruct (Qeq_bool q 0) eqn:Z; [discriminate|].
      destruct (polynomial T x1); try discriminate. injection H as <-.
      cbn [number]. rewrite (IHx1 _ eq_refl).
      change (of p0 / Q2R q = Q2R (/ q)%Q * of p0). rewrite Q2R_inv; [unfold Rdiv; ring|]. intros E. apply Qeq_bool_iff in E. congruence.
  Qed.
  Lemma reading_means T b f c : agrees T -> reading T b f = Some c -> true_of (b, f) -> Qeval_nformula env c.
  Proof.
    intros A H. destruct f as [|[x|x] o [y|y]| | | | | | | | |]; try discriminate. cbn [reading] in H.
    destruct (polynomial T x) as [p|] eqn:P; [|discriminate]. destruct (polynomial T y) as [q|] eqn:Q; [|discriminate].
    apply (polynomial_means T x A) in P. apply (polynomial_means T y A) in Q. injection H as <-.
    unfold true_of. destruct o, b; cbn [fst snd holds compares extended_number less at_most]; rewrite P, Q; intros L;
      first [apply above_means|apply at_least_means]; rewrite of_sub; lra.
  Qed.

  Lemma is_zero_means x : says (is_zero x) <-> number W t x = 0.
  Proof. cbn. rewrite RMicromega.Q2R_0. lra. Qed.
  Lemma inverse_of_means x : number W t (inverse_of x) = / number W t x.
  Proof. cbn. rewrite RMicromega.Q2R_1. unfold Rdiv. ring. Qed.
  Lemma lower_means o a b : o = LT \/ o = LE -> says (lower o a b) <-> says (Compare a o b).
  Proof.
    intros [-> | ->]; destruct a as [x|x], b as [y|y]; unfold lower; try reflexivity;
      cbn [holds compares]; rewrite ?is_zero_means; cbn [extended_number]; rewrite ?inverse_of_means;
      repeat match goal with |- context [Req_EM_T ?u 0] => destruct (Req_EM_T u 0) end; cbn; tauto.
  Qed.
  Lemma plain_means f : says (plain f) <-> says f.
  Proof.
    destruct f as [|a [| | |] b| | | | | | | | |]; try reflexivity; unfold plain;
      rewrite lower_means by auto; reflexivity.
  Qed.

  Lemma true_cons f G : true_of f -> (forall g, In g G -> true_of g) -> forall g, In g (f :: G) -> true_of g.
  Proof. intros H K g [<-|I]; auto. Qed.

  Theorem check_sound tr : forall T G C, agrees T -> (forall f, In f G -> true_of f) -> keeps C ->
    check T G C tr = true -> False.
  Proof.
    induction tr as [w|i|i j|i r IH|i r1 IH1 r2 IH2|i r IH|i r IH|n a r IH|x y r1 IH1 r2 IH2|x y r1 IH1 r2 IH2
      |x y up w r IH|p r1 IH1 r2 IH2]; intros T G C A H K E; cbn [check] in E.
    - exact (absurd C w K E).
    - destruct (nth_error G i) as [[b f]|] eqn:N; [|discriminate]. apply nth_error_In, H in N.
      destruct f; try discriminate. destruct b, b0; cbn in *; try discriminate; auto.
    - destruct (nth_error G i) as [[[|] f]|] eqn:N; try discriminate.
      destruct (nth_error G j) as [[[|] g]|] eqn:N'; try discriminate.
      apply same_eq in E as <-. apply nth_error_In, H in N. apply nth_error_In, H in N'. exact (N' N).
    - destruct (nth_error G i) as [[b f]|] eqn:N; [|discriminate]. apply nth_error_In, H in N.
      destruct f; try (destruct b; discriminate).
      + destruct b; (refine (IH _ _ _ A _ K E); apply true_cons; [|assumption]); cbn in *; [assumption|apply NNPP, N].
      + destruct b; [|discriminate]. destruct N. refine (IH _ _ _ A _ K E). repeat (apply true_cons; [assumption|]). exact H.
      + destruct b; [discriminate|]. cbn in N. apply not_or_and in N as [? ?].
        refine (IH _ _ _ A _ K E). repeat (apply true_cons; [assumption|]). exact H.
    - destruct (nth_error G i) as [[b f]|] eqn:N; [|discriminate]. apply nth_error_In, H in N.
      destruct b, f; try discriminate; apply andb_prop in E as [E1 E2]; cbn in N.
      + destruct N as [N|N]; [refine (IH1 _ _ _ A _ K E1)|refine (IH2 _ _ _ A _ K E2)]; apply true_cons; assumption.
      + apply not_and_or in N as [N|N]; [refine (IH1 _ _ _ A _ K E1)|refine (IH2 _ _ _ A _ K E2)];
          apply true_cons; assumption.
    - destruct (nth_error G i) as [[b f]|] eqn:N; [|discriminate]. apply nth_error_In, H in N.
      refine (IH _ _ _ A _ K E). apply true_cons; [|assumption].
      unfold true_of in *. cbn [fst snd] in *. destruct b; rewrite plain_means; exact N.
    - destruct (nth_error G i) as [[b f]|] eqn:N; [|discriminate]. apply nth_error_In, H in N.
      destruct (reading T b f) as [c|] eqn:X; [|discriminate].
      refine (IH _ _ _ A H _ E). apply keeps_cons; [exact (reading_means T b f c A X N)|assumption].
    - destruct (polynomial T (Siz n a)) as [p|] eqn:P; [|discriminate].
      apply (polynomial_means T _ A) in P. refine (IH _ _ _ A H _ E). apply keeps_cons; [|assumption].
      apply above_means. rewrite <- P. apply measure_positive.
    - destruct (polynomial T x) as [p|] eqn:P; [|discriminate]. destruct (polynomial T y) as [q|] eqn:Q; [|discriminate].
      apply (polynomial_means T _ A) in P. apply (polynomial_means T _ A) in Q. apply andb_prop in E as [E1 E2].
      destruct (Rle_dec (number W t x) (number W t y)) as [L|L].
      + refine (IH1 _ _ _ _ H _ E1).
        * apply agrees_cons; [|assumption]. cbn [number]. rewrite Rmax_right by exact L. exact Q.
        * apply keeps_cons; [|assumption]. apply at_least_means. rewrite of_sub. lra.
      + refine (IH2 _ _ _ _ H _ E2).
        * apply agrees_cons; [|assumption]. cbn [number]. rewrite Rmax_left by lra. exact P.
        * apply keeps_cons; [|assumption]. apply above_means. rewrite of_sub. lra.
    - destruct (polynomial T x) as [p|] eqn:P; [|discriminate]. destruct (polynomial T y) as [q|] eqn:Q; [|discriminate].
      apply (polynomial_means T _ A) in P. apply (polynomial_means T _ A) in Q. apply andb_prop in E as [E1 E2].
      destruct (Rle_dec (number W t x) (number W t y)) as [L|L].
      + refine (IH1 _ _ _ _ H _ E1).
        * apply agrees_cons; [|assumption]. cbn [number]. rewrite Rmin_left by exact L. exact P.
        * apply keeps_cons; [|assumption]. apply at_least_means. rewrite of_sub. lra.
      + refine (IH2 _ _ _ _ H _ E2).
        * apply agrees_cons; [|assumption]. cbn [number]. rewrite Rmin_right by lra. exact Q.
        * apply keeps_cons; [|assumption]. apply above_means. rewrite of_sub. lra.
    - destruct (polynomial T x) as [p|] eqn:P; [|discriminate]. destruct (polynomial T y) as [q|] eqn:Q; [|discriminate].
      destruct (polynomial T (Div x y)) as [s|] eqn:S; [|discriminate]. apply andb_prop in E as [E1 E2].
      apply (polynomial_means T _ A) in P. apply (polynomial_means T _ A) in Q. apply (polynomial_means T _ A) in S.
      assert (Z : number W t y <> 0).
      { intros Z. refine (absurd (at_least (if up then PEopp q else q) :: C) w _ E1). apply keeps_cons; [|exact K].
        apply at_least_means. destruct up; rewrite ?of_opp; lra. }
      refine (IH _ _ _ A H _ E2). apply keeps_cons; [|assumption]. apply zero_means.
      rewrite of_sub, of_mul, <- P, <- Q, <- S. cbn [number]. field. exact Z.
    - apply andb_prop in E as [E1 E2]. destruct (Rle_dec 0 (of p)) as [L|L].
      + refine (IH1 _ _ _ A H _ E1). apply keeps_cons; [|assumption]. apply at_least_means. exact L.
      + refine (IH2 _ _ _ A H _ E2). apply keeps_cons; [|assumption]. apply above_means. rewrite of_opp. lra.
  Qed.
End Sound.

(* --- facts ---------------------------------------------------------------------------------------------- *)
(* xs: the terms that are variables of polynomials, the first of them number 1 *)
Fixpoint numbered (n : positive) (xs : list term) : table :=
  match xs with [] => [] | x :: xs => (x, PEX n) :: numbered (Pos.succ n) xs end.
Definition known_of (T : table) (b : bound) : option constraint :=
  match b with
  | at_least_0 p => option_map at_least (polynomial T (Par p))
  | above_0 p => option_map above (polynomial T (Par p))
  | own_at_least n a low => option_map (fun e => at_least (PEsub e (PEc low))) (polynomial T (Sig (Own n) a))
  | own_at_most n a high => option_map (fun e => at_least (PEsub (PEc high) e)) (polynomial T (Sig (Own n) a))
  end.
Fixpoint known (T : table) (bounds : list bound) : list constraint :=
  match bounds with
  | [] => []
  | b :: bounds => match known_of T b with Some c => c :: known T bounds | None => known T bounds end
  end.
Definition settles bounds (xs : list term) f tr : bool :=
  let T := numbered 1 xs in check T [(false, f)] (known T bounds) tr.

Theorem settled bounds xs f tr : settles bounds xs f tr = true -> valid_always bounds f.
Proof.
  intros E W named t B. apply NNPP. intros N. unfold settles in E.
  set (env := fun n : positive => number W t (nth (Nat.pred (Pos.to_nat n)) xs (Num 0))).
  assert (A : agrees W t env (numbered 1 xs)).
  { assert (G : forall ys n, (forall k, nth k ys (Num 0) = nth (k + Nat.pred (Pos.to_nat n)) xs (Num 0)) ->
      agrees W t env (numbered n ys)).
    { induction ys as [|y ys IH]; intros n H; [intros x p []|]. apply agrees_cons.
      - specialize (H 0%nat). cbn in H. subst y. reflexivity.
      - apply IH. intros k. specialize (H (S k)). cbn [nth] in H. rewrite H. f_equal.
        rewrite Pos2Nat.inj_succ. pose proof (Pos2Nat.is_pos n). lia. }
    apply G. intros k. f_equal. cbn. lia. }
  refine (check_sound W named t env tr _ _ _ A _ _ E).
  - intros f' [<-|[]]. exact N.
  - clear E. unfold respects in B. induction bounds as [|b bounds IH]; cbn [known]; [intros c []|].
    inversion B as [|x l B1 B2]; subst. specialize (IH B2).
    unfold known_of, option_map. destruct b as [p|p|n a low|n a high]; cbn [keeps_to] in B1;
      (match goal with |- context [polynomial ?T ?x] => destruct (polynomial T x) as [e|] eqn:P end; [|exact IH]);
      apply (polynomial_means W t env _ _ A) in P; cbn [number] in P; (apply keeps_cons; [|exact IH]);
      [apply at_least_means|apply above_means|apply at_least_means|apply at_least_means];
      rewrite ?of_sub, <- P; try exact B1; specialize (B1 t);
      [change (QReval_expr env (PEc low)) with (Q2R low)|change (QReval_expr env (PEc high)) with (Q2R high)]; lra.
Qed.
