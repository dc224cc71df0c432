(* Facts about motion, and inductions over time.  NOT TRUSTED: proved.

   A proof that assumes motion rests on instances of schemas (docs/explanation/motion.md).  `says` makes the formula
   of an instance from its arguments, and `instance_holds` proves that it holds in every motion; inductions hold in every
   world.  `holds_of_motions` at the end: where a claim is valid under instances as premises, it holds in every motion
   without them. *)
From Coq Require Import Reals QArith Qreals String List Bool Arith Lia Lra Classical.
From Roadproof Require Import Meaning Linear Tableau Motion Integral.
Import ListNotations.
Open Scope R_scope.

(* --- terms and formulas without what does not matter ---------------------------------------------------- *)
(* Numbers are computed, and zeros, double negations, `true` and `false` left out. *)
Definition known (x : term) : option Q := match x with Num q => Some q | _ => None end.
Definition add x y :=
  match known x, known y with
  | Some p, Some q => Num (Qred (p + q))
  | Some p, None => if Qeq_bool p 0 then y else Add x y
  | None, Some q => if Qeq_bool q 0 then x else Add x y
  | None, None => Add x y
  end.
Definition mul x y :=
  match known x, known y with
  | Some p, Some q => Num (Qred (p * q))
  | Some p, None => if Qeq_bool p 0 then Num 0 else Mul x y
  | None, Some q => if Qeq_bool q 0 then Num 0 else Mul x y
  | None, None => Mul x y
  end.
Fixpoint power (p : Q) (n : nat) : Q := match n with O => 1%Q | S n => Qred (p * power p n) end.
Definition pow_ x n := match known x with Some p => Num (power p n) | None => Pow x n end.
Definition div x y :=
  match known x, known y with
  | Some p, Some q => if Qeq_bool q 0 then Div x y else Num (Qred (p / q))
  | _, _ => Div x y
  end.
Definition max_ x y :=
  match known x, known y with Some p, Some q => if Qle_bool p q then y else x | _, _ => Max x y end.
Definition min_ x y :=
  match known x, known y with Some p, Some q => if Qle_bool p q then x else y | _, _ => Min x y end.
Fixpoint simple (x : term) : term :=
  match x with
  | Num q => Num (Qred q)
  | Add x y => add (simple x) (simple y)
  | Mul x y => mul (simple x) (simple y)
  | Pow x n => pow_ (simple x) n
  | Div x y => div (simple x) (simple y)
  | Max x y => max_ (simple x) (simple y)
  | Min x y => min_ (simple x) (simple y)
  | _ => x
  end.
Definition simple_side (s : side) : side := match s with Fin x => Fin (simple x) | Inv x => Inv (simple x) end.

Definition not_ f := match f with Truth b => Truth (negb b) | Not g => g | _ => Not f end.
Definition and_ f g :=
  match f, g with
  | Truth true, _ => g
  | _, Truth true => f
  | Truth false, _ | _, Truth false => Truth false
  | _, _ => And f g
  end.
Definition or_ f g :=
  match f, g with
  | Truth false, _ => g
  | _, Truth false => f
  | Truth true, _ | _, Truth true => Truth true
  | _, _ => Or f g
  end.
Fixpoint plain (f : formula) : formula :=
  match f with
  | Truth _ | Occupies _ _ => f
  | Compare l o r => Compare (simple_side l) o (simple_side r)
  | Some_ n d f => Some_ n d (plain f)
  | Every n d f => Every n d (plain f)
  | Not f => not_ (plain f)
  | And f g => and_ (plain f) (plain g)
  | Or f g => or_ (plain f) (plain g)
  | Until f lo hi g => Until (plain f) (simple lo) (option_map simple hi) (plain g)
  | Eventually lo hi f => Eventually (simple lo) (option_map simple hi) (plain f)
  | Always lo hi f => Always (simple lo) (option_map simple hi) (plain f)
  end.

Lemma Q2R_red p : Q2R (Qred p) = Q2R p.
Proof. apply Qeq_eqR, Qred_correct. Qed.
Lemma Q2R_half : Q2R (1 # 2) = / 2.
Proof. unfold Q2R. simpl. lra. Qed.
Lemma zero_right p : Qeq_bool p 0 = true -> Q2R p = 0.
Proof. intros H. apply Qeq_bool_iff in H. rewrite (Qeq_eqR _ _ H). apply Q2R_0. Qed.
Lemma above_right p : Qle_bool 0 p = true -> 0 <= Q2R p.
Proof. intros H. apply Qle_bool_iff in H. apply Qle_Rle in H. rewrite Q2R_0 in H. exact H. Qed.
Lemma power_right p n : Q2R (power p n) = Q2R p ^ n.
Proof. induction n as [|n IH]; cbn [power pow]; [apply Q2R_1|]. rewrite Q2R_red, Q2R_mult, IH. reflexivity. Qed.

Section Plain.
  Variable W : world.
  Notation number := (number W).
  Notation holds := (holds W).

  Lemma known_right x p t : known x = Some p -> number t x = Q2R p.
  Proof. destruct x; try discriminate. intros H. injection H as <-. reflexivity. Qed.

  Ltac by_numbers t :=
    repeat match goal with
           | |- context [known ?x] =>
               let p := fresh "p" in let K := fresh "K" in
               destruct (known x) as [p|] eqn:K; [apply (known_right x p t) in K|clear K]
           | |- context [Qeq_bool ?p 0] =>
               let Z := fresh "Z" in destruct (Qeq_bool p 0) eqn:Z; [apply zero_right in Z|]
           end.
  Lemma add_right t x y : number t (add x y) = number t x + number t y.
  Proof. unfold add. by_numbers t; cbn [Meaning.number]; rewrite ?Q2R_red, ?Q2R_plus; lra. Qed.
  Lemma mul_right t x y : number t (mul x y) = number t x * number t y.
  Proof.
    unfold mul. by_numbers t; cbn [Meaning.number]; rewrite ?Q2R_red, ?Q2R_mult, ?Q2R_0;
      repeat match goal with H : number t _ = _ |- _ => rewrite H; clear H end;
      repeat match goal with H : Q2R _ = 0 |- _ => rewrite H; clear H end; ring.
  Qed.
  Lemma pow_right t x n : number t (pow_ x n) = number t x ^ n.
  Proof. unfold pow_. by_numbers t; cbn [Meaning.number]; [rewrite power_right, K|]; reflexivity. Qed.
  Lemma div_right t x y : number t (div x y) = number t x / number t y.
  Proof.
    unfold div. destruct (known x) as [p|] eqn:K; [|reflexivity]. destruct (known y) as [q|] eqn:L; [|reflexivity].
    apply (known_right _ _ t) in K. apply (known_right _ _ t) in L.
    destruct (Qeq_bool q 0) eqn:Z; [reflexivity|]. cbn [Meaning.number]. rewrite Q2R_red, Q2R_div, K, L; [reflexivity|].
    intros E. apply Qeq_bool_iff in E. congruence.
  Qed.
  Lemma in_order p q : (if Qle_bool p q then Q2R p <= Q2R q else Q2R q <= Q2R p).
  Proof.
    destruct (Qle_bool p q) eqn:E; apply Qle_Rle; [apply Qle_bool_iff, E|].
    apply Qlt_le_weak, Qnot_le_lt. intros L. apply Qle_bool_iff in L. congruence.
  Qed.
  Lemma max_right t x y : number t (max_ x y) = Rmax (number t x) (number t y).
  Proof.
    unfold max_. destruct (known x) as [p|] eqn:K; [|reflexivity]. destruct (known y) as [q|] eqn:L; [|reflexivity].
    apply (known_right _ _ t) in K. apply (known_right _ _ t) in L. pose proof (in_order p q) as O.
    rewrite <- K, <- L in O. destruct (Qle_bool p q); symmetry; [apply Rmax_right|apply Rmax_left]; exact O.
  Qed.
  Lemma min_right t x y : number t (min_ x y) = Rmin (number t x) (number t y).
  Proof.
    unfold min_. destruct (known x) as [p|] eqn:K; [|reflexivity]. destruct (known y) as [q|] eqn:L; [|reflexivity].
    apply (known_right _ _ t) in K. apply (known_right _ _ t) in L. pose proof (in_order p q) as O.
    rewrite <- K, <- L in O. destruct (Qle_bool p q); symmetry; [apply Rmin_left|apply Rmin_right]; exact O.
  Qed.
  Lemma simple_right t x : number t (simple x) = number t x.
  Proof.
    induction x; cbn [simple]; try reflexivity;
      rewrite ?add_right, ?mul_right, ?pow_right, ?div_right, ?max_right, ?min_right; cbn [Meaning.number];
      rewrite ?Q2R_red; congruence.
  Qed.
  Lemma simple_within t lo hi u : within W t (simple lo) (option_map simple hi) u <-> within W t lo hi u.
  Proof. unfold within. rewrite simple_right. destruct hi; cbn [option_map]; rewrite ?simple_right; reflexivity. Qed.
  Lemma simple_side_right t s : extended_number W t (simple_side s) = extended_number W t s.
  Proof. destruct s; cbn [simple_side extended_number]; rewrite simple_right; reflexivity. Qed.

  Variable named : string -> element W.
  Lemma not_right b t f : holds named b t (not_ f) <-> ~ holds named b t f.
  Proof.
    destruct f; cbn [not_ Meaning.holds]; try reflexivity.
    - destruct b0; simpl; split; congruence.
    - split; [tauto|apply NNPP].
  Qed.
  Lemma truth_right b t v : holds named b t (Truth v) <-> v = true.
  Proof. reflexivity. Qed.
  Lemma and_right b t f g : holds named b t (and_ f g) <-> holds named b t f /\ holds named b t g.
  Proof.
    assert (H : holds named b t (And f g) <-> holds named b t f /\ holds named b t g) by reflexivity.
    destruct f as [[|]| | | | | | | | | |], g as [[|]| | | | | | | | | |]; unfold and_;
      rewrite ?truth_right; try exact H; intuition congruence.
  Qed.
  Lemma or_right b t f g : holds named b t (or_ f g) <-> holds named b t f \/ holds named b t g.
  Proof.
    assert (H : holds named b t (Or f g) <-> holds named b t f \/ holds named b t g) by reflexivity.
    destruct f as [[|]| | | | | | | | | |], g as [[|]| | | | | | | | | |]; unfold or_;
      rewrite ?truth_right; try exact H; intuition congruence.
  Qed.
  Lemma plain_right f : forall b t, holds named b t (plain f) <-> holds named b t f.
  Proof.
    induction f; intros p t; cbn [plain]; rewrite ?not_right, ?and_right, ?or_right; cbn [Meaning.holds]; try tauto.
    - rewrite !simple_side_right. reflexivity.
    - split; intros [e [A B]]; exists e; (split; [exact A|apply IHf, B]).
    - split; intros A e B; apply IHf, A, B.
    - rewrite IHf. reflexivity.
    - rewrite IHf1, IHf2. reflexivity.
    - rewrite IHf1, IHf2. reflexivity.
    - split; intros [u [A [B C]]]; exists u; rewrite simple_within, ?simple_right in *;
        (split; [exact A|split; [apply IHf2, B|]]); intros w X; apply IHf1, C; rewrite ?simple_right in *; exact X.
    - split; intros [u [A B]]; exists u; rewrite simple_within in *; (split; [exact A|apply IHf, B]).
    - split; intros A u B; apply IHf, A; rewrite simple_within in *; exact B.
  Qed.
End Plain.

(* --- rates, continuity, open formulas ------------------------------------------------------------------- *)
Fixpoint rate (x : term) : option term :=
  if term_rigid x then Some (Num 0)
  else match x with
       | Sig n a => option_map (fun r => Sig r a) (rate_of n)
       | Add x y => match rate x, rate y with Some x, Some y => Some (Add x y) | _, _ => None end
       | Mul x y =>
           if term_rigid x then option_map (Mul x) (rate y)
           else if term_rigid y then option_map (fun x => Mul x y) (rate x) else None
       | Div x y => if term_rigid y then option_map (fun x => Div x y) (rate x) else None
       | _ => None
       end.
Fixpoint continuous (x : term) : bool :=
  match x with
  | Num _ | Par _ | Var _ | Siz _ _ => true
  | Sig n _ => match rate_of n with Some _ => true | None => false end
  | Add x y | Mul x y | Max x y | Min x y => continuous x && continuous y
  | Pow x _ => continuous x
  | Div x y => continuous x && term_rigid y
  end.
(* Whether the instants at which f is true (false) linger. *)
Fixpoint is_open (positive : bool) (f : formula) : bool :=
  match f with
  | Truth _ => true
  | Compare (Fin x) (LT | GT) (Fin y) => positive && continuous x && continuous y
  | Compare (Fin x) (LE | GE) (Fin y) => negb positive && continuous x && continuous y
  | Occupies _ _ => positive
  | Not f => is_open (negb positive) f
  | And f g | Or f g => is_open positive f && is_open positive g
  | Some_ _ _ f | Every _ _ f => is_open positive f
  | _ => false
  end.

Section Moving.
  Variable W : world.
  Hypothesis M : motion W.
  Notation number := (number W).

  Lemma rigid_integral x : term_rigid x = true -> is_integral (fun t => number t x) (fun t => number t (Num 0)).
  Proof.
    intros H. apply (same_integral (fun _ => number 0 x) (fun _ => 0));
      [intros t; apply number_rigid, H|intros t; symmetry; apply Q2R_0|apply integral_constant].
  Qed.
  Lemma rate_right x : forall x', rate x = Some x' -> is_integral (fun t => number t x) (fun t => number t x').
  Proof.
    induction x; intros x' H; cbn [rate] in H;
      match type of H with
      | (if ?r then _ else _) = _ =>
          destruct r eqn:F; [injection H as <-; apply rigid_integral, F|]
      | Some _ = _ => injection H as <-; apply rigid_integral; reflexivity
      end; try discriminate.
    - destruct (rate_of n) as [r|] eqn:E; [|discriminate]. injection H as <-. apply (grows W M), E.
    - destruct (rate x1) as [y1|]; [|discriminate]. destruct (rate x2) as [y2|]; [|discriminate]. injection H as <-.
      apply integral_plus; [apply IHx1|apply IHx2]; reflexivity.
    - destruct (term_rigid x1) eqn:F1; [|destruct (term_rigid x2) eqn:F2; [|discriminate]].
      + destruct (rate x2) as [y2|]; [|discriminate]. injection H as <-.
        apply (same_integral (fun t => number 0 x1 * number t x2) (fun t => number 0 x1 * number t y2));
          [intros t; cbn [Meaning.number]; rewrite (number_rigid W x1 t 0 F1); reflexivity..|].
        apply integral_times, IHx2. reflexivity.
      + destruct (rate x1) as [y1|]; [|discriminate]. injection H as <-.
        apply (same_integral (fun t => number 0 x2 * number t x1) (fun t => number 0 x2 * number t y1));
          [intros t; cbn [Meaning.number]; rewrite (number_rigid W x2 t 0 F2); ring..|].
        apply integral_times, IHx1. reflexivity.
    - destruct (term_rigid x2) eqn:F2; [|discriminate].
      destruct (rate x1) as [y1|]; [|discriminate]. injection H as <-.
      apply (same_integral (fun t => / number 0 x2 * number t x1) (fun t => / number 0 x2 * number t y1));
        [intros t; cbn [Meaning.number]; rewrite (number_rigid W x2 t 0 F2); unfold Rdiv; ring..|].
      apply integral_times, IHx1. reflexivity.
  Qed.

  Lemma steady_same F G : (forall t, F t = G t) -> steady F -> steady G.
  Proof. intros E. rewrite (FunctionalExtensionality.functional_extensionality F G E). trivial. Qed.
  Lemma steady_constant k : steady (fun _ => k).
  Proof. apply (integral_steady _ (fun _ => 0)), integral_constant. Qed.
  Lemma steady_plus F G : steady F -> steady G -> steady (fun t => F t + G t).
  Proof. intros A B. exact (continuity_plus _ _ A B). Qed.
  Lemma steady_mult F G : steady F -> steady G -> steady (fun t => F t * G t).
  Proof. intros A B. exact (continuity_mult _ _ A B). Qed.
  Lemma steady_minus F G : steady F -> steady G -> steady (fun t => F t - G t).
  Proof. intros A B. exact (continuity_minus _ _ A B). Qed.
  Lemma steady_abs F : steady F -> steady (fun t => Rabs (F t)).
  Proof. intros A. exact (continuity_comp _ _ A Rcontinuity_abs). Qed.
  Lemma steady_pow F n : steady F -> steady (fun t => F t ^ n).
  Proof. intros A. induction n as [|n IH]; [apply steady_constant|]. exact (steady_mult _ _ A IH). Qed.
  Lemma continuous_right x : continuous x = true -> steady (fun t => number t x).
  Proof.
    induction x; cbn [continuous]; intros H; try (apply andb_prop in H as [H1 H2]).
    - apply (steady_constant (Q2R q)).
    - apply (steady_constant (parameter W name)).
    - apply (steady_constant (variable W name)).
    - destruct (rate_of n) as [r|] eqn:E; [|discriminate]. apply (integral_steady _ _ (grows W M n r a E)).
    - apply (steady_constant (measure W n a)).
    - apply steady_plus; auto.
    - apply steady_mult; auto.
    - apply steady_pow; auto.
    - apply (steady_same (fun t => number t x1 * / number 0 x2)).
      + intros t. cbn [Meaning.number]. rewrite (number_rigid W x2 t 0 H2). reflexivity.
      + apply steady_mult; [auto|apply steady_constant].
    - apply (steady_same (fun t => (number t x1 + number t x2 + Rabs (number t x1 - number t x2)) * / 2)).
      + intros t. cbn [Meaning.number]. unfold Rmax, Rabs. destruct Rle_dec, Rcase_abs; lra.
      + apply steady_mult; [|apply steady_constant].
        apply steady_plus; [apply steady_plus|apply steady_abs, steady_minus]; auto.
    - apply (steady_same (fun t => (number t x1 + number t x2 - Rabs (number t x1 - number t x2)) * / 2)).
      + intros t. cbn [Meaning.number]. unfold Rmin, Rabs. destruct Rle_dec, Rcase_abs; lra.
      + apply steady_mult; [|apply steady_constant].
        apply steady_minus; [apply steady_plus|apply steady_abs, steady_minus]; auto.
  Qed.

  Lemma less_lingers x y : continuous x = true -> continuous y = true -> lingers (fun t => number t x < number t y).
  Proof.
    intros A B. apply (lingers_same (fun t => 0 < number t y - number t x)); [intros t; lra|].
    apply steady_lingers, steady_minus; apply continuous_right; assumption.
  Qed.
  Variable named : string -> element W.
  Definition side_of (positive : bool) (p : Prop) : Prop := if positive then p else ~ p.
  Lemma is_open_right f : forall positive b, is_open positive f = true ->
    lingers (fun t => side_of positive (holds W named b t f)).
  Proof.
    induction f; intros pos b' H; cbn [is_open] in H; try discriminate.
    - exact (lingers_always (side_of pos (b = true))).
    - destruct l as [x|x], r as [y|y]; try (destruct o; discriminate).
      destruct o; destruct pos; cbn in H; try discriminate; apply andb_prop in H as [A B];
        unfold side_of; cbn [holds compares extended_number less at_most].
      + apply less_lingers; assumption.
      + apply (lingers_same (fun t => number t y < number t x)); [intros t; split; lra|apply less_lingers; assumption].
      + apply less_lingers; assumption.
      + apply (lingers_same (fun t => number t x < number t y)); [intros t; split; lra|apply less_lingers; assumption].
    - destruct pos; [|discriminate]. apply (overlaps W M).
    - destruct (finite W M) as [road F]. destruct pos; unfold side_of.
      + apply (lingers_some (member W named b' d)). intros e. apply (IHf true), H.
      + apply (lingers_same (fun t => forall e, member W named b' d e -> ~ holds W named (bind W b' n e) t f)).
        * intros t. cbn [holds]. split; [intros A [e [B C]]; exact (A e B C)|intros A e B C; apply A; exists e; auto].
        * apply (lingers_every road); [exact F|]. intros e. apply (IHf false), H.
    - destruct (finite W M) as [road F]. destruct pos; unfold side_of.
      + apply (lingers_every road (member W named b' d)); [exact F|]. intros e. apply (IHf true), H.
      + apply (lingers_same (fun t => exists e, member W named b' d e /\ ~ holds W named (bind W b' n e) t f)).
        * intros t. cbn [holds]. split; [intros [e [A B]] C; exact (B (C e A))|].
          intros A. apply NNPP. intros B. apply A. intros e C. apply NNPP. intros D. apply B. exists e. auto.
        * apply lingers_some. intros e. apply (IHf false), H.
    - specialize (IHf (negb pos) b' H). destruct pos; [exact IHf|].
      refine (lingers_same _ _ _ IHf). intros t. unfold side_of. cbn [negb holds]. tauto.
    - apply andb_prop in H as [A B]. specialize (IHf1 pos b' A). specialize (IHf2 pos b' B). destruct pos.
      + exact (lingers_and _ _ IHf1 IHf2).
      + refine (lingers_same _ _ _ (lingers_or _ _ IHf1 IHf2)). intros t. unfold side_of. cbn [holds]. tauto.
    - apply andb_prop in H as [A B]. specialize (IHf1 pos b' A). specialize (IHf2 pos b' B). destruct pos.
      + exact (lingers_or _ _ IHf1 IHf2).
      + refine (lingers_same _ _ _ (lingers_and _ _ IHf1 IHf2)). intros t. unfold side_of. cbn [holds]. tauto.
  Qed.
End Moving.

(* --- schemas -------------------------------------------------------------------------------------------- *)
Inductive schema :=
| At_most (x y : term)
| Below (x y : term)
| Meets (x y : term)
| Leaves (p : formula)
| Within (x y speed time : term)
| After (x y speed time : term)
| Within_twice (x y speed growth time : term)
| After_twice (x y speed growth time : term)
| Repeats (p : formula) (lo hi : term)
| Lasts (p : formula) (time : term).
(* Inductions over time hold in worlds that are no motions, too. *)
Definition is_induction (s : schema) : bool := match s with Repeats _ _ _ | Lasts _ _ => true | _ => false end.

Definition always p := Always (Num 0) None p.
Definition until p q := Until p (Num 0) None q.
Definition implies p q := Or (Not p) q.
Definition le x y := Compare (Fin x) LE (Fin y).
Definition lt x y := Compare (Fin x) LT (Fin y).
Definition ge x y := Compare (Fin x) GE (Fin y).
Definition half_square growth time := Mul (Mul (Mul growth time) time) (Num (1 # 2)).

Definition above (x : term) : bool :=
  match simple x with Num p => Qle_bool 0 p && negb (Qeq_bool p 0) | _ => false end.
(* Whether a time is never below 0, by its form. *)
Fixpoint never_below (bounds : list bound) (x : term) : bool :=
  match x with
  | Num p => Qle_bool 0 p
  | Par p => existsb (fun b => match b with at_least_0 q | above_0 q => String.eqb p q | _ => false end) bounds
  | Siz _ _ => true
  | Add x y | Mul x y | Div x y | Max x y | Min x y => never_below bounds x && never_below bounds y
  | Pow x _ => never_below bounds x
  | _ => false
  end.

Definition where_ (b : bool) (f : formula) : option formula := if b then Some f else None.
Definition with_rates (x y : term) (f : term -> term -> option formula) : option formula :=
  match rate x, rate y with Some x', Some y' => f x' y' | _, _ => None end.
Definition says (bounds : list bound) (s : schema) : option formula :=
  match s with
  | At_most x y => with_rates x y (fun x' y' =>
      Some (always (implies (le x y) (Not (until (Or (le x y) (le x' y')) (Not (le x y)))))))
  | Below x y => with_rates x y (fun x' y' =>
      Some (always (implies (lt x y) (Not (until (le x' y') (Not (lt x y)))))))
  | Meets x y =>
      where_ (continuous x && continuous y)
        (always (implies (lt x y) (Or (always (lt x y)) (until (lt x y) (And (le x y) (ge x y))))))
  | Leaves p => where_ (is_open true p) (always (implies p (Or (always p) (until p (Not p)))))
  | Within x y r d => with_rates x y (fun x' y' =>
      where_ (term_rigid r && term_rigid d)
        (always (implies (le x y)
          (Not (Until (le x' (Add y' r)) (Num 0) (Some d) (Not (le x (Add y (Mul (Max (Num 0) r) d)))))))))
  | After x y r d => with_rates x y (fun x' y' =>
      where_ (term_rigid r && term_rigid d && never_below bounds d)
        (always (implies (And (le x y) (Always (Num 0) (Some d) (le x' (Add y' r))))
          (Always d (Some d) (le x (Add y (Mul r d)))))))
  | Within_twice x y v r d => with_rates x y (fun x' y' => with_rates x' y' (fun x'' y'' =>
      where_ (term_rigid v && term_rigid r && term_rigid d)
        (always (implies (And (le x y) (le x' (Add y' v)))
          (Not (Until (le x'' (Add y'' r)) (Num 0) (Some d)
            (Not (le x (Add y (Add (Mul (Max (Num 0) v) d) (half_square (Max (Num 0) r) d)))))))))))
  | After_twice x y v r d => with_rates x y (fun x' y' => with_rates x' y' (fun x'' y'' =>
      where_ (term_rigid v && term_rigid r && term_rigid d && never_below bounds d)
        (always (implies (And (And (le x y) (le x' (Add y' v))) (Always (Num 0) (Some d) (le x'' (Add y'' r))))
          (Always d (Some d) (le x (Add y (Add (Mul v d) (half_square r d)))))))))
  | Repeats p lo hi =>
      where_ (above lo && term_rigid hi)
        (always (implies (And p (always (implies p (Eventually lo (Some hi) p))))
          (always (Eventually (Num 0) (Some hi) p))))
  | Lasts p d =>
      where_ (above d)
        (always (implies (And p (always (implies p (Always (Num 0) (Some d) p)))) (always p)))
  end.

Section Says.
  Variable W : world.
  Variable bounds : list bound.
  Hypothesis B : respects W bounds.
  Variable named : string -> element W.
  Variable b : nat -> element W.
  Notation number := (number W).
  Notation holds := (holds W named b).

  Lemma always_right t p : holds t (always p) <-> forall u, t <= u -> holds u p.
  Proof.
    unfold always, within. cbn [Meaning.holds]. unfold within. cbn [Meaning.number]. rewrite Q2R_0, Rplus_0_r.
    split; [intros H u U; apply H; split; [exact U|exact I]|intros H u [U _]; apply H, U].
  Qed.
  Lemma until_right t p q : holds t (until p q) <-> exists u, t <= u /\ holds u q /\ forall w, t <= w < u -> holds w p.
  Proof.
    unfold until. cbn [Meaning.holds]. unfold within. cbn [Meaning.number]. rewrite Q2R_0, Rplus_0_r.
    split; intros [u H]; exists u; tauto.
  Qed.
  Lemma until_time t p d q : term_rigid d = true -> holds t (Until p (Num 0) (Some d) q) ->
    exists u, t <= u <= t + number 0 d /\ holds u q /\ forall w, t <= w < u -> holds w p.
  Proof.
    intros D. cbn [Meaning.holds]. unfold within. cbn [Meaning.number]. rewrite Q2R_0, Rplus_0_r.
    rewrite (number_rigid W d t 0 D). intros [u [U H]]. exists u. tauto.
  Qed.
  Lemma throughout t d p : term_rigid d = true ->
    holds t (Always (Num 0) (Some d) p) <-> forall u, t <= u <= t + number 0 d -> holds u p.
  Proof.
    intros D. cbn [Meaning.holds]. unfold within. cbn [Meaning.number]. rewrite Q2R_0, Rplus_0_r.
    rewrite (number_rigid W d t 0 D). reflexivity.
  Qed.
  Lemma just_after t d p : term_rigid d = true -> holds (t + number 0 d) p -> holds t (Always d (Some d) p).
  Proof.
    intros D H. cbn [Meaning.holds]. unfold within. rewrite (number_rigid W d t 0 D).
    intros u U. replace u with (t + number 0 d) by lra. exact H.
  Qed.
  Lemma implies_right t p q : (holds t p -> holds t q) -> holds t (implies p q).
  Proof. unfold implies. cbn [Meaning.holds]. tauto. Qed.
  Lemma implied_right t p q : holds t (implies p q) -> holds t p -> holds t q.
  Proof. unfold implies. cbn [Meaning.holds]. tauto. Qed.
  Lemma le_right t x y : holds t (le x y) <-> number t x - number t y <= 0.
  Proof. unfold le. cbn [Meaning.holds compares extended_number at_most]. lra. Qed.
  Lemma lt_right t x y : holds t (lt x y) <-> number t x - number t y < 0.
  Proof. unfold lt. cbn [Meaning.holds compares extended_number less]. lra. Qed.
  Lemma ge_right t x y : holds t (ge x y) <-> 0 <= number t x - number t y.
  Proof. unfold ge. cbn [Meaning.holds compares extended_number at_most]. lra. Qed.
  Lemma more_right t x y z : term_rigid z = true ->
    holds t (le x (Add y z)) <-> number t x - number t y <= number 0 z.
  Proof.
    intros Z. unfold le. cbn [Meaning.holds compares extended_number at_most Meaning.number].
    rewrite (number_rigid W z t 0 Z). lra.
  Qed.

  Lemma never_below_right x t : never_below bounds x = true -> 0 <= number t x.
  Proof.
    assert (P : forall x y, 0 <= x -> 0 <= y -> 0 <= x / y).
    { intros u v U V. destruct (Req_dec v 0) as [->|N]; [unfold Rdiv; rewrite Rinv_0; lra|].
      apply Rmult_le_pos; [exact U|]. left. apply Rinv_0_lt_compat. lra. }
    induction x; cbn [never_below Meaning.number]; intros H; try discriminate; try (apply andb_prop in H as [H1 H2]).
    - apply above_right, H.
    - apply existsb_exists in H as [c [C E]]. unfold respects in B. rewrite Forall_forall in B. specialize (B c C).
      destruct c as [p|p| |]; try discriminate; apply String.eqb_eq in E as <-; cbn [keeps_to] in B; lra.
    - left. apply measure_positive.
    - specialize (IHx1 H1). specialize (IHx2 H2). lra.
    - apply Rmult_le_pos; auto.
    - apply pow_le. auto.
    - apply P; auto.
    - apply Rle_trans with (2 := Rmax_l _ _). auto.
    - apply Rmin_glb; auto.
  Qed.
  Lemma above_right' x : above x = true -> forall t, 0 < number t x /\ number t x = number 0 x.
  Proof.
    unfold above. intros H t. rewrite <- (simple_right W t x), <- (simple_right W 0 x).
    destruct (simple x); try discriminate. cbn [Meaning.number]. split; [|reflexivity].
    apply andb_prop in H as [H N]. apply above_right in H. destruct (Rle_lt_or_eq_dec _ _ H) as [L|E]; [exact L|].
    exfalso. rewrite <- Q2R_0 in E. apply eqR_Qeq in E. apply negb_true_iff in N.
    assert (Qeq_bool q 0 = true) by (apply Qeq_bool_iff; symmetry; exact E). congruence.
  Qed.

  (* --- inductions --- *)
  Lemma reached x c : 0 < c -> exists n, x <= INR n * c.
  Proof.
    intros C. destruct (archimed (x / c)) as [U _]. exists (Z.to_nat (up (x / c))).
    assert (N : IZR (up (x / c)) <= INR (Z.to_nat (up (x / c)))).
    { rewrite INR_IZR_INZ. apply IZR_le. lia. }
    assert (E : x / c * c = x) by (field; lra). nra.
  Qed.
  Lemma repeats_right p lo hi t : above lo = true -> term_rigid hi = true ->
    holds t (always (implies (And p (always (implies p (Eventually lo (Some hi) p))))
          (always (Eventually (Num 0) (Some hi) p)))).
  Proof.
    intros L H. apply always_right. intros T _. apply implies_right. cbn [Meaning.holds]. intros [P A].
    apply always_right. intros u U. destruct (above_right' lo L T) as [L0 LE].
    assert (again : forall s, T <= s -> holds s p -> exists s', s + number 0 lo <= s' <= s + number 0 hi /\ holds s' p).
    { intros s S Q. pose proof (implied_right _ _ _ (proj1 (always_right _ _) A s S) Q) as [s' [S' Q']].
      unfold within in S'. rewrite (number_rigid W hi s 0 H) in S'.
      rewrite (proj2 (above_right' lo L s)) in S'. exists s'. split; [exact S'|exact Q']. }
    assert (K : forall n s, T <= s -> holds s p -> s <= u <= s + INR n * number 0 lo ->
      exists w, u <= w <= u + number 0 hi /\ holds w p).
    { induction n as [|n IH]; intros s S Q X.
      - exists s. cbn [INR] in X. destruct (again s S Q) as [s' [S' _]]. split; [lra|exact Q].
      - destruct (again s S Q) as [s' [S' Q']]. destruct (Rle_lt_dec u s') as [Y|Y].
        + exists s'. split; [lra|exact Q'].
        + apply (IH s'); [lra|exact Q'|]. rewrite S_INR in X. lra. }
    destruct (reached (u - T) (number 0 lo)) as [n N]; [lra|].
    destruct (K n T) as [w [X Q]]; [lra|exact P|lra|].
    exists w. split; [|exact Q]. unfold within. cbn [Meaning.number]. rewrite Q2R_0, (number_rigid W hi u 0 H). lra.
  Qed.
  Lemma lasts_right p d t : above d = true ->
    holds t (always (implies (And p (always (implies p (Always (Num 0) (Some d) p)))) (always p))).
  Proof.
    intros L. apply always_right. intros T _. apply implies_right. cbn [Meaning.holds]. intros [P A].
    apply always_right. intros u U. destruct (above_right' d L T) as [L0 LE].
    assert (K : forall n s, T <= s -> holds s p -> s <= u <= s + INR n * number 0 d -> holds u p).
    { induction n as [|n IH]; intros s S Q X.
      - cbn [INR] in X. replace u with s by lra. exact Q.
      - pose proof (implied_right _ _ _ (proj1 (always_right _ _) A s S) Q) as C.
        cbn [Meaning.holds] in C. unfold within in C. cbn [Meaning.number] in C. rewrite Q2R_0 in C.
        rewrite (proj2 (above_right' d L s)) in C. rewrite S_INR in X.
        destruct (Rle_lt_dec u (s + number 0 d)) as [Y|Y]; [apply C; lra|].
        apply (IH (s + number 0 d)); [lra|apply C; lra|lra]. }
    destruct (reached (u - T) (number 0 d)) as [n N]; [lra|].
    apply (K n T); [lra|exact P|lra].
  Qed.

  (* --- motion --- *)
  Hypothesis M : motion W.
  Lemma difference x y x' y' : rate x = Some x' -> rate y = Some y' ->
    is_integral (fun t => number t x - number t y) (fun t => number t x' - number t y').
  Proof. intros X Y. apply integral_minus; apply (rate_right W M); assumption. Qed.

  Section Rates.
    Variables x y x' y' : term.
    Hypotheses (X : rate x = Some x') (Y : rate y = Some y').
    Notation e := (fun t => number t x - number t y).
    Notation e' := (fun t => number t x' - number t y').
    Let D := difference x y x' y' X Y.

    Lemma at_most_right t : 0 <= t ->
      holds t (always (implies (le x y) (Not (until (Or (le x y) (le x' y')) (Not (le x y)))))).
    Proof.
      intros T0. apply always_right. intros T T1. apply implies_right. rewrite le_right. intros A.
      cbn [Meaning.holds]. rewrite until_right. intros [u [U [N H]]]. cbn [Meaning.holds] in N. rewrite le_right in N.
      destruct (last_before e T u (integral_steady _ _ D) ltac:(lra) A ltac:(lra)) as [r [R1 [R2 R3]]].
      assert (e u - e r <= 0 * (u - r)); [|cbv beta in *; lra].
      apply (grows_at_most e e'); [exact D|lra|]. intros w V.
      specialize (R3 w ltac:(lra)). specialize (H w ltac:(lra)). cbn [Meaning.holds] in H. rewrite !le_right in H.
      cbv beta in *. destruct H as [H|H]; lra.
    Qed.
    Lemma below_right t : 0 <= t -> holds t (always (implies (lt x y) (Not (until (le x' y') (Not (lt x y)))))).
    Proof.
      intros T0. apply always_right. intros T T1. apply implies_right. rewrite lt_right. intros A.
      cbn [Meaning.holds]. rewrite until_right. intros [u [U [N H]]]. cbn [Meaning.holds] in N. rewrite lt_right in N.
      assert (e u - e T <= 0 * (u - T)); [|cbv beta in *; lra].
      apply (grows_at_most e e'); [exact D|lra|]. intros w V. apply le_right, H. lra.
    Qed.

    Variables r d : term.
    Hypotheses (R : term_rigid r = true) (Dr : term_rigid d = true).
    Lemma within_right t : 0 <= t -> holds t (always (implies (le x y)
      (Not (Until (le x' (Add y' r)) (Num 0) (Some d) (Not (le x (Add y (Mul (Max (Num 0) r) d)))))))).
    Proof.
      intros T0. apply always_right. intros T T1. apply implies_right. rewrite le_right. intros A E.
      apply until_time in E as [u [U [N H]]]; [|exact Dr]. cbn [Meaning.holds] in N.
      rewrite more_right in N by (cbn [term_rigid]; rewrite R, Dr; reflexivity).
      apply N. cbn [Meaning.number]. rewrite Q2R_0.
      assert (G : e u - e T <= number 0 r * (u - T)).
      { apply (grows_at_most e e'); [exact D|lra|]. intros w V. apply more_right, H; [exact R|lra]. }
      pose proof (Rmax_l 0 (number 0 r)). pose proof (Rmax_r 0 (number 0 r)). cbv beta in *.
      set (m := Rmax 0 (number 0 r)) in *.
      assert (number 0 r * (u - T) <= m * (u - T)) by (apply Rmult_le_compat_r; lra).
      assert (m * (u - T) <= m * number 0 d) by (apply Rmult_le_compat_l; lra). lra.
    Qed.
    Hypothesis Dn : never_below bounds d = true.
    Lemma after_right t : 0 <= t -> holds t (always (implies (And (le x y) (Always (Num 0) (Some d) (le x' (Add y' r))))
      (Always d (Some d) (le x (Add y (Mul r d)))))).
    Proof.
      intros T0. apply always_right. intros T T1. apply implies_right. intros [A H]. apply just_after; [exact Dr|].
      rewrite le_right in A. rewrite more_right by (cbn [term_rigid]; rewrite R, Dr; reflexivity).
      pose proof (never_below_right d 0 Dn) as P. cbn [Meaning.number]. set (u := T + number 0 d) in *.
      assert (G : e u - e T <= number 0 r * (u - T)).
      { apply (grows_at_most e e'); [exact D|unfold u; lra|].
        intros w V. apply more_right; [exact R|]. apply (proj1 (throughout T d _ Dr) H); unfold u in *; lra. }
      cbv beta in *. replace (u - T) with (number 0 d) in G by (unfold u; ring). lra.
    Qed.
  End Rates.

  Section Rates_of_rates.
    Variables x y x' y' x'' y'' v r d : term.
    Hypotheses (X : rate x = Some x') (Y : rate y = Some y') (X' : rate x' = Some x'') (Y' : rate y' = Some y'').
    Hypotheses (V : term_rigid v = true) (R : term_rigid r = true) (Dr : term_rigid d = true).
    Notation e := (fun t => number t x - number t y).
    Notation e' := (fun t => number t x' - number t y').
    Notation e'' := (fun t => number t x'' - number t y'').
    Let D := difference x y x' y' X Y.
    Let D' := difference x' y' x'' y'' X' Y'.

    Lemma within_twice_right t : 0 <= t -> holds t (always (implies (And (le x y) (le x' (Add y' v)))
      (Not (Until (le x'' (Add y'' r)) (Num 0) (Some d)
        (Not (le x (Add y (Add (Mul (Max (Num 0) v) d) (half_square (Max (Num 0) r) d))))))))).
    Proof.
      intros T0. apply always_right. intros T T1. apply implies_right. intros [A S] E. rewrite le_right in A.
      rewrite more_right in S by exact V.
      apply until_time in E as [u [U [N H]]]; [|exact Dr]. cbn [Meaning.holds] in N.
      rewrite more_right in N by (unfold half_square; cbn [term_rigid]; rewrite V, R, Dr; reflexivity).
      apply N. unfold half_square. cbn [Meaning.number]. rewrite Q2R_0, Q2R_half.
      assert (G : e u - e T <= number 0 v * (u - T) + number 0 r * (u - T) ^ 2 / 2).
      { apply (grows_twice e e' e''); [exact D|exact D'|lra|exact S|].
        intros w K. apply more_right, H; [exact R|lra]. }
      cbv beta in *. set (z := u - T) in *. assert (Z : 0 <= z <= number 0 d) by (unfold z; lra).
      pose proof (Rmax_l 0 (number 0 r)). pose proof (Rmax_r 0 (number 0 r)). set (m := Rmax 0 (number 0 r)) in *.
      pose proof (Rmax_l 0 (number 0 v)). pose proof (Rmax_r 0 (number 0 v)). set (n := Rmax 0 (number 0 v)) in *.
      assert (number 0 v * z <= n * z) by (apply Rmult_le_compat_r; lra).
      assert (n * z <= n * number 0 d) by (apply Rmult_le_compat_l; lra).
      assert (Z2 : z ^ 2 <= number 0 d * number 0 d) by (replace (z ^ 2) with (z * z) by ring; apply Rmult_le_compat; lra).
      assert (number 0 r * z ^ 2 <= m * z ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0|lra]).
      assert (m * z ^ 2 <= m * (number 0 d * number 0 d)) by (apply Rmult_le_compat_l; lra). lra.
    Qed.
    Hypothesis Dn : never_below bounds d = true.
    Lemma after_twice_right t : 0 <= t -> holds t (always (implies
      (And (And (le x y) (le x' (Add y' v))) (Always (Num 0) (Some d) (le x'' (Add y'' r))))
      (Always d (Some d) (le x (Add y (Add (Mul v d) (half_square r d))))))).
    Proof.
      intros T0. apply always_right. intros T T1. apply implies_right. intros [[A S] H]. apply just_after; [exact Dr|].
      rewrite le_right in A. rewrite more_right in S by exact V.
      rewrite more_right by (unfold half_square; cbn [term_rigid]; rewrite V, R, Dr; reflexivity).
      pose proof (never_below_right d 0 Dn) as P. unfold half_square. cbn [Meaning.number]. rewrite Q2R_half.
      set (u := T + number 0 d) in *.
      assert (G : e u - e T <= number 0 v * (u - T) + number 0 r * (u - T) ^ 2 / 2).
      { apply (grows_twice e e' e''); [exact D|exact D'|unfold u; lra|exact S|].
        intros w K. apply more_right; [exact R|]. apply (proj1 (throughout T d _ Dr) H); unfold u in *; lra. }
      cbv beta in *. replace (u - T) with (number 0 d) in G by (unfold u; ring). lra.
    Qed.
  End Rates_of_rates.

  Lemma leaves_right p t : is_open true p = true -> 0 <= t ->
    holds t (always (implies p (Or (always p) (until p (Not p))))).
  Proof.
    intros O T0. apply always_right. intros T T1. apply implies_right. intros P.
    pose proof (is_open_right W M named p true b O) as L. unfold side_of in L.
    destruct (first_after _ T L ltac:(lra) P) as [A|[u [U [N H]]]].
    - left. apply always_right. exact A.
    - right. apply until_right. exists u. auto.
  Qed.
  Lemma meets_right x y t : continuous x = true -> continuous y = true -> 0 <= t ->
    holds t (always (implies (lt x y) (Or (always (lt x y)) (until (lt x y) (And (le x y) (ge x y)))))).
  Proof.
    intros X Y T0. apply always_right. intros T T1. apply implies_right. intros P.
    assert (L : lingers (fun t => holds t (lt x y))).
    { apply (lingers_same (fun t => number t x < number t y)); [intros s; rewrite lt_right; lra|].
      apply (less_lingers W M); assumption. }
    destruct (first_after _ T L ltac:(lra) P) as [A|[u [U [N H]]]].
    - left. apply always_right. exact A.
    - right. apply until_right. exists u. split; [exact U|split; [|exact H]].
      rewrite lt_right in N. cbn [Meaning.holds]. rewrite le_right, ge_right. split; [|lra].
      apply Rnot_lt_le. intros Z.
      assert (S : lingers (fun t => number t y < number t x)) by (apply (less_lingers W M); assumption).
      destruct (S u ltac:(lra) ltac:(lra)) as [w [V K]].
      assert (Q : T < u). { destruct U as [U|U]; [exact U|]. subst u. rewrite lt_right in P. lra. }
      set (c := Rmax T (u - w / 2)). assert (c < u) by (apply Rmax_lub_lt; lra).
      pose proof (Rmax_l T (u - w / 2)). pose proof (Rmax_r T (u - w / 2)). fold c in H1, H2.
      assert (C : holds c (lt x y)) by (apply H; lra). rewrite lt_right in C.
      specialize (K c ltac:(lra) ltac:(lra)). lra.
  Qed.
End Says.

Theorem instance_holds W named bounds s f : respects W bounds -> (is_induction s = false -> motion W) ->
  says bounds s = Some f -> forall b t, 0 <= t -> holds W named b t f.
Proof.
  intros B M H b t T.
  destruct s as [x y|x y|x y|p|x y r d|x y r d|x y v r d|x y v r d|p lo hi|p d]; cbn [says] in H;
    try specialize (M eq_refl); unfold with_rates, where_ in H;
    repeat match type of H with
           | context [match rate ?x with _ => _ end] => let E := fresh "E" in destruct (rate x) eqn:E; try discriminate
           end;
    try match type of H with (if ?c then _ else _) = _ => destruct c eqn:C; [|discriminate] end;
    repeat match goal with C : _ && _ = true |- _ => apply andb_prop in C as [? ?] end;
    injection H as <-.
  - apply at_most_right; assumption.
  - apply below_right; assumption.
  - apply meets_right; assumption.
  - apply leaves_right; assumption.
  - apply within_right; assumption.
  - apply (after_right W bounds); assumption.
  - apply within_twice_right; assumption.
  - apply (after_twice_right W bounds); assumption.
  - apply repeats_right; assumption.
  - apply lasts_right; assumption.
Qed.

(* --- claims --------------------------------------------------------------------------------------------- *)
(* What is supposed, as single facts, and what follows from it. *)
Fixpoint conjuncts (f : formula) : list formula := match f with And f g => conjuncts f ++ conjuncts g | _ => [f] end.
Definition parted (f : formula) : formula * formula :=
  match f with Or (Not p) q => (p, q) | Not p => (p, Truth false) | _ => (Truth true, f) end.
Definition is_instance (bounds : list bound) (schemas : list schema) (f : formula) : bool :=
  existsb (fun s => match says bounds s with Some g => same (plain g) (plain f) | None => false end) schemas.
(* Whether `supposed` is the claim with instances of schemas as further premises. *)
Definition adds (bounds : list bound) (schemas : list schema) (supposed claim : formula) : bool :=
  let (p, q) := parted supposed in
  let fact := is_instance bounds schemas in
  (same q claim && forallb fact (conjuncts p))
  || (let (p', q') := parted claim in
      same q q' && forallb (fun f => existsb (same f) (conjuncts p') || fact f) (conjuncts p)).

Section Claims.
  Variable W : world.
  Variable bounds : list bound.
  Hypothesis B : respects W bounds.
  Variable named : string -> element W.
  Variable b : nat -> element W.
  Notation holds := (holds W named b 0).

  Lemma conjuncts_right f : (forall g, In g (conjuncts f) -> holds g) <-> holds f.
  Proof.
    induction f; cbn [conjuncts]; try (split; [intros H; apply H; left; reflexivity|intros H g [<-|[]]; exact H]).
    cbn [Meaning.holds]. rewrite <- IHf1, <- IHf2. split.
    - intros H. split; intros g G; apply H, in_or_app; [left|right]; exact G.
    - intros [H1 H2] g G. apply in_app_or in G as [G|G]; auto.
  Qed.
  Lemma parted_right f p q : parted f = (p, q) -> holds f <-> (holds p -> holds q).
  Proof.
    destruct f; intros E; try (injection E as <- <-; cbn [Meaning.holds]; intuition congruence).
    destruct f1; injection E as <- <-; cbn [Meaning.holds]; intuition; tauto.
  Qed.
  Variable schemas : list schema.
  Hypothesis M : forallb is_induction schemas = false -> motion W.
  Lemma is_instance_right f : is_instance bounds schemas f = true -> holds f.
  Proof.
    intros H. apply existsb_exists in H as [s [S H]]. destruct (says bounds s) as [g|] eqn:E; [|discriminate].
    apply same_eq in H. apply (plain_right W named). rewrite <- H. apply plain_right.
    apply (instance_holds W named bounds s g B); [|exact E|lra].
    intros N. apply M. apply not_true_is_false. intros A. rewrite forallb_forall in A. specialize (A s S). congruence.
  Qed.
  Lemma adds_right supposed claim : adds bounds schemas supposed claim = true -> holds supposed -> holds claim.
  Proof.
    unfold adds. destruct (parted supposed) as [p q] eqn:E. destruct (parted claim) as [p' q'] eqn:E'. intros H S.
    rewrite (parted_right _ _ _ E) in S. apply orb_prop in H as [H|H]; apply andb_prop in H as [H1 H2];
      apply same_eq in H1 as <-; rewrite forallb_forall in H2.
    - apply S, conjuncts_right. intros g G. exact (is_instance_right g (H2 g G)).
    - apply (proj2 (parted_right _ _ _ E')). intros P. apply S, conjuncts_right. intros g G. specialize (H2 g G).
      apply orb_prop in H2 as [H2|H2]; [|apply is_instance_right, H2].
      apply existsb_exists in H2 as [g' [G' H2]]. apply same_eq in H2 as <-.
      apply (proj2 (conjuncts_right p') P), G'.
  Qed.
End Claims.

Theorem holds_of_motions bounds schemas supposed claim :
  valid bounds supposed -> adds bounds schemas supposed claim = true -> valid_of_motions bounds claim.
Proof.
  intros V A W named M B. apply (adds_right W bounds B named _ schemas (fun _ => M) supposed); [exact A|].
  apply V, B.
Qed.
(* Where there are inductions alone, the claim holds in every world. *)
Theorem holds_by_induction bounds schemas supposed claim :
  valid bounds supposed -> forallb is_induction schemas && adds bounds schemas supposed claim = true ->
  valid bounds claim.
Proof.
  intros V A W named B. apply andb_prop in A as [I A].
  apply (adds_right W bounds B named _ schemas) with (supposed := supposed); [congruence|exact A|].
  apply V, B.
Qed.
