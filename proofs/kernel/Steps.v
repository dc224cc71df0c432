(* Claims read on a recorded course of things.  NOT TRUSTED: proved, and used by tests alone.

   A trace of steps gives the value of each signal for the times from 0 to dt, from dt to 2 dt, and so on; the
   last one stays for ever.  `reads` is a program that says where on such a trace a formula is true, and the
   theorem `reads_right` says that it is right: that is what Meaning.v says of the world `world_of` the trace.
   Formulas speak of no roads, and bounds of intervals are multiples of dt; else there is no answer.  The tests
   run it on printed formulas, and compare it with the judge. *)
From Coq Require Import Reals QArith Qreals String List Bool Arith Lia Lra.
From Roadproof Require Import Meaning.
Import ListNotations.
Open Scope R_scope.

Record trace := {
  dt : Q;
  last : nat;                                              (* the number of the last step, from 0 *)
  course : signal -> vehicle -> list Q;
  sized : size -> vehicle -> Q;
  parametric : string -> Q }.

Section Reads.
  Variable T : trace.
  Notation final := (last T).

  (* --- terms ------------------------------------------------------------------------------------------ *)
  Definition step (n : signal) (a : vehicle) (k : nat) : Q := nth (Nat.min k final) (course T n a) 0%Q.
  Definition positive_size n a : Q := if Qlt_le_dec 0 (sized T n a) then sized T n a else 1%Q.
  Definition both {A B C} (f : A -> B -> C) (x : option A) (y : option B) : option C :=
    match x, y with Some x, Some y => Some (f x y) | _, _ => None end.
  Fixpoint power (q : Q) (n : nat) : Q := match n with O => 1%Q | S n => Qred (q * power q n) end.
  Fixpoint rational (k : nat) (x : term) : option Q :=
    match x with
    | Num q => Some q
    | Par p => Some (parametric T p)
    | Var v => None
    | Sig n a => Some (step n a k)
    | Siz n a => Some (positive_size n a)
    | Add x y => both (fun p q => Qred (p + q)) (rational k x) (rational k y)
    | Mul x y => both (fun p q => Qred (p * q)) (rational k x) (rational k y)
    | Pow x n => option_map (fun p => power p n) (rational k x)
    | Div x y =>
        match rational k x, rational k y with
        | Some p, Some q => if Qeq_bool q 0 then None else Some (Qred (p / q))
        | _, _ => None
        end
    | Max x y => both (fun p q => if Qle_bool p q then q else p) (rational k x) (rational k y)
    | Min x y => both (fun p q => if Qle_bool p q then p else q) (rational k x) (rational k y)
    end.
  (* None is infinity *)
  Definition extended_rational (k : nat) (s : side) : option (option Q) :=
    match s with
    | Fin x => option_map Some (rational k x)
    | Inv x => option_map (fun q => if Qeq_bool q 0 then None else Some (/ q)%Q) (rational k x)
    end.
  Definition below (a b : option Q) : bool :=
    match a, b with Some p, Some q => negb (Qle_bool q p) | Some _, None => true | None, _ => false end.
  Definition not_above (a b : option Q) : bool :=
    match a, b with Some p, Some q => Qle_bool p q | _, None => true | None, Some _ => false end.
  Definition decides (o : comparison) (a b : option Q) : bool :=
    match o with LT => below a b | LE => not_above a b | GT => below b a | GE => not_above b a end.

  (* --- formulas: whether true at each step ------------------------------------------------------------- *)
  Definition at_ (v : list bool) (k : nat) : bool := nth (Nat.min k final) v false.
  Definition tabled (g : nat -> bool) : list bool := map g (seq 0 (S final)).
  Fixpoint gathered (l : list (option bool)) : option (list bool) :=
    match l with [] => Some [] | x :: l => both cons x (gathered l) end.
  (* how many steps a bound is; it must not speak of signals *)
  Fixpoint rigid_term (x : term) : bool :=
    match x with
    | Num _ | Par _ => true
    | Add x y | Mul x y | Div x y | Max x y | Min x y => rigid_term x && rigid_term y
    | Pow x _ => rigid_term x
    | _ => false
    end.
  Definition steps (x : term) : option nat :=
    if rigid_term x then
      match rational 0 x with
      | Some q =>
          let r := Qred (q / dt T) in
          if (0 <=? Qnum r)%Z && (Zpos (Qden r) =? 1)%Z then Some (Z.to_nat (Qnum r)) else None
      | None => None
      end
    else None.
  (* the first step of a window after k, and how many follow that differ: None where it is empty *)
  Definition span (lo : term) (hi : option term) : option (nat * option nat) :=
    match steps lo, hi with
    | Some a, None => Some (a, Some final)
    | Some a, Some h =>
        option_map (fun b => (a, if Nat.leb a b then Some (Nat.min (b - a) final) else None)) (steps h)
    | None, _ => None
    end.
  Definition some_of (v : list bool) (a : nat) (n : option nat) (k : nat) : bool :=
    match n with None => false | Some n => existsb (fun m => at_ v (k + a + m)) (seq 0 (S n)) end.
  Definition all_of (v : list bool) (a : nat) (n : option nat) (k : nat) : bool :=
    match n with None => true | Some n => forallb (fun m => at_ v (k + a + m)) (seq 0 (S n)) end.
  Definition until_of (u v : list bool) (a : nat) (n : option nat) (k : nat) : bool :=
    match n with
    | None => false
    | Some n =>
        existsb (fun m => at_ v (k + a + m) && forallb (fun i => at_ u (k + a + i)) (seq 0 m)) (seq 0 (S n))
    end.
  Fixpoint reads (f : formula) : option (list bool) :=
    match f with
    | Truth b => Some (tabled (fun _ => b))
    | Compare l o r =>
        gathered (map (fun k => both (decides o) (extended_rational k l) (extended_rational k r)) (seq 0 (S final)))
    | Not f => option_map (fun v => tabled (fun k => negb (at_ v k))) (reads f)
    | And f g => both (fun u v => tabled (fun k => at_ u k && at_ v k)) (reads f) (reads g)
    | Or f g => both (fun u v => tabled (fun k => at_ u k || at_ v k)) (reads f) (reads g)
    | Eventually lo hi f => both (fun w v => tabled (some_of v (fst w) (snd w))) (span lo hi) (reads f)
    | Always lo hi f => both (fun w v => tabled (all_of v (fst w) (snd w))) (span lo hi) (reads f)
    | Until f lo hi g =>
        both (fun w uv => tabled (until_of (fst uv) (snd uv) (fst w) (snd w))) (span lo hi) (both pair (reads f) (reads g))
    | Occupies _ _ | Some_ _ _ _ | Every _ _ _ => None
    end.
  Definition answer (f : formula) : option bool := option_map (fun v => at_ v 0) (reads f).

  (* --- the world of a trace ----------------------------------------------------------------------------- *)
  Definition piece (t : R) : nat := Z.to_nat (Int_part (t / Q2R (dt T))).
  Lemma sizes_positive n a : 0 < Q2R (positive_size n a).
  Proof.
    unfold positive_size. destruct (Qlt_le_dec 0 (sized T n a)) as [H|H].
    - apply Qlt_Rlt in H. unfold Q2R in H at 1. simpl in H. lra.
    - unfold Q2R; simpl; lra.
  Qed.
  Definition world_of : world.
  Proof.
    refine {| element := bool; somewhere := true; parameter := fun p => Q2R (parametric T p); variable := fun _ => 0;
              value := fun n a t => Q2R (step n a (piece t)); measure := fun n a => Q2R (positive_size n a);
              measure_positive := sizes_positive; shape := fun _ => {| s_from := None; s_to := None; d_from := 0; d_to := 1 |};
              adjacent := fun l m => l <> m; adjacent_irreflexive := _; adjacent_symmetric := _;
              lanelets := fun l m => l = m; lanelets_reflexive := _; zone_of := fun _ => main |}.
    - intros l H. apply H. reflexivity.
    - intros l m H E. apply H. symmetry. exact E.
    - reflexivity.
  Defined.
  Notation W := world_of.

  (* --- that it is right ---------------------------------------------------------------------------------- *)
  Hypothesis forward : (0 < dt T)%Q.
  Lemma forward_R : 0 < Q2R (dt T).
  Proof. apply Qlt_Rlt in forward. unfold Q2R in forward at 1. simpl in forward. lra. Qed.
  (* x: the time in steps *)
  Definition inside (k : nat) (t : R) : Prop := INR k <= t / Q2R (dt T) < INR k + 1.
  Lemma piece_inside k t : inside k t -> piece t = k.
  Proof.
    intros [A B]. unfold piece. rewrite INR_IZR_INZ in A, B.
    unfold Int_part. rewrite <- (tech_up (t / Q2R (dt T)) (Z.of_nat k + 1)) by (rewrite plus_IZR; lra).
    replace (Z.of_nat k + 1 - 1)%Z with (Z.of_nat k) by lia. apply Nat2Z.id.
  Qed.
  Lemma has_piece t : 0 <= t / Q2R (dt T) -> exists k, inside k t.
  Proof.
    intros H. exists (piece t). unfold inside, piece. destruct (base_Int_part (t / Q2R (dt T))) as [A B].
    set (z := Int_part (t / Q2R (dt T))) in *.
    assert (0 <= z)%Z. { assert (-1 < z)%Z; [apply lt_IZR; simpl; lra|lia]. }
    rewrite INR_IZR_INZ, Z2Nat.id by assumption. lra.
  Qed.

  Lemma Q2R_red q : Q2R (Qred q) = Q2R q. Proof. apply Qeq_eqR, Qred_correct. Qed.
  Lemma Q2R_0 : Q2R 0 = 0. Proof. unfold Q2R; simpl; lra. Qed.
  Lemma Q2R_1 : Q2R 1 = 1. Proof. unfold Q2R; simpl; lra. Qed.
  Lemma Q2R_power q n : Q2R (power q n) = Q2R q ^ n.
  Proof. induction n as [|n IH]; cbn [power pow]; [exact Q2R_1|]. rewrite Q2R_red, Q2R_mult, IH. reflexivity. Qed.
  Lemma Qle_means p q : Qle_bool p q = true <-> Q2R p <= Q2R q.
  Proof. rewrite Qle_bool_iff. split; [apply Qle_Rle|apply Rle_Qle]. Qed.
  Lemma Qle_not p q : Qle_bool p q = false <-> Q2R q < Q2R p.
  Proof.
    destruct (Qle_bool p q) eqn:E; [apply Qle_means in E|]; split; intros H; try discriminate; try lra; auto.
    apply Rnot_le_lt. intros L. apply Qle_means in L. congruence.
  Qed.
  Lemma Qeq_means q : Qeq_bool q 0 = true <-> Q2R q = 0.
  Proof.
    rewrite Qeq_bool_iff. split; intros H; [rewrite (Qeq_eqR _ _ H); exact Q2R_0|].
    apply eqR_Qeq. rewrite H, Q2R_0. reflexivity.
  Qed.
  Lemma Qeq_not q : Qeq_bool q 0 = false -> ~ q == 0.
  Proof. intros H E. apply Qeq_bool_iff in E. congruence. Qed.

  Lemma some_same {A} (x y : A) : Some x = Some y -> x = y. Proof. congruence. Qed.
  Lemma rational_means k t x : inside k t -> forall q, rational k x = Some q -> Q2R q = number W t x.
  Proof.
    intros I. induction x; cbn [rational]; intros p H; try discriminate; cbn [number].
    1, 2, 4: apply some_same in H; rewrite <- H; reflexivity.
    - apply some_same in H; rewrite <- H. cbn. rewrite (piece_inside k t I). reflexivity.
    - destruct (rational k x1), (rational k x2); try discriminate; cbn [both option_map] in H; apply some_same in H; rewrite <- H.
      rewrite Q2R_red, Q2R_plus, (IHx1 _ eq_refl), (IHx2 _ eq_refl). reflexivity.
    - destruct (rational k x1), (rational k x2); try discriminate; cbn [both option_map] in H; apply some_same in H; rewrite <- H.
      rewrite Q2R_red, Q2R_mult, (IHx1 _ eq_refl), (IHx2 _ eq_refl). reflexivity.
    - destruct (rational k x); try discriminate; cbn [both option_map] in H; apply some_same in H; rewrite <- H.
      rewrite Q2R_power, (IHx _ eq_refl). reflexivity.
    - destruct (rational k x1), (rational k x2); try discriminate. destruct (Qeq_bool q0 0) eqn:Z; [discriminate|].
      apply some_same in H; rewrite <- H. rewrite Q2R_red, Q2R_div by (apply Qeq_not, Z).
      rewrite (IHx1 _ eq_refl), (IHx2 _ eq_refl). reflexivity.
    - destruct (rational k x1), (rational k x2); try discriminate; cbn [both option_map] in H; apply some_same in H; rewrite <- H.
      rewrite <- (IHx1 _ eq_refl), <- (IHx2 _ eq_refl). destruct (Qle_bool q q0) eqn:L.
      + apply Qle_means in L. rewrite Rmax_right by exact L. reflexivity.
      + apply Qle_not in L. rewrite Rmax_left by lra. reflexivity.
    - destruct (rational k x1), (rational k x2); try discriminate; cbn [both option_map] in H; apply some_same in H; rewrite <- H.
      rewrite <- (IHx1 _ eq_refl), <- (IHx2 _ eq_refl). destruct (Qle_bool q q0) eqn:L.
      + apply Qle_means in L. rewrite Rmin_left by exact L. reflexivity.
      + apply Qle_not in L. rewrite Rmin_right by lra. reflexivity.
  Qed.
  Definition real (x : option Q) : extended := match x with Some q => Real (Q2R q) | None => Infinity end.
  Lemma extended_means k t s x : inside k t -> extended_rational k s = Some x -> extended_number W t s = real x.
  Proof.
    intros I H. destruct s as [y|y]; cbn in H; destruct (rational k y) as [q|] eqn:E; try discriminate;
      injection H as <-; apply (rational_means k t y I) in E; cbn [extended_number]; rewrite <- E.
    - reflexivity.
    - destruct (Qeq_bool q 0) eqn:Z.
      + apply Qeq_means in Z. destruct (Req_EM_T (Q2R q) 0); [reflexivity|contradiction].
      + destruct (Req_EM_T (Q2R q) 0) as [N|N]; [apply Qeq_means in N; congruence|].
        cbn [real]. rewrite Q2R_inv by (apply Qeq_not, Z). reflexivity.
  Qed.
  Lemma decides_means o a b : decides o a b = true <-> compares o (real a) (real b).
  Proof.
    destruct o, a as [p|], b as [q|]; cbn; rewrite ?negb_true_iff, ?Qle_not, ?Qle_means; try tauto;
      split; intros; try discriminate; try contradiction; auto.
  Qed.

  (* a table says where f is true *)
  Variable named : string -> element W.
  Variable bound : nat -> element W.
  Notation says t f := (holds W named bound t f).
  Definition right (f : formula) (v : list bool) : Prop := forall k t, inside k t -> (says t f <-> at_ v k = true).

  Lemma at_tabled g k : at_ (tabled g) k = g (Nat.min k final).
  Proof.
    unfold at_, tabled. rewrite (nth_indep _ false (g 0%nat)) by (rewrite map_length, seq_length; lia).
    rewrite (map_nth g), seq_nth by lia. reflexivity.
  Qed.
  Lemma at_late v k : (final <= k)%nat -> at_ v k = at_ v final.
  Proof. intros H. unfold at_. f_equal. lia. Qed.
  Lemma at_least_min v k : at_ v (Nat.min k final) = at_ v k.
  Proof. unfold at_. f_equal. lia. Qed.
  (* what a window sees from step k on is what it sees from the last step on, where k is later *)
  Lemma at_moved v k j : at_ v (Nat.min k final + j) = at_ v (k + j).
  Proof. unfold at_. f_equal. lia. Qed.

  Lemma steps_mean x n t : steps x = Some n -> number W t x = INR n * Q2R (dt T).
  Proof.
    unfold steps. destruct (rigid_term x) eqn:G; [|discriminate]. destruct (rational 0 x) as [q|] eqn:E; [|discriminate].
    cbv zeta. destruct (_ && _) eqn:B; [|discriminate]. intros H. apply some_same in H. subst n. apply andb_prop in B as [B1 B2].
    apply Z.leb_le in B1. apply Z.eqb_eq in B2. pose proof forward_R as F.
    assert (I : inside 0 0). { unfold inside, Rdiv. rewrite Rmult_0_l. simpl. lra. }
    apply (rational_means 0 0 x I) in E.
    assert (M : number W t x = number W 0 x).
    { clear - G. induction x; cbn in *; try discriminate; try reflexivity;
        try (apply andb_prop in G as [? ?]; rewrite IHx1, IHx2 by assumption; reflexivity).
      rewrite IHx by assumption. reflexivity. }
    rewrite M, <- E. set (r := Qred (q / dt T)) in *.
    assert (R1 : Q2R r = Q2R q / Q2R (dt T)).
    { unfold r. rewrite Q2R_red, Q2R_div; [reflexivity|]. intros Z. rewrite Z in forward. discriminate. }
    assert (R2 : Q2R r = INR (Z.to_nat (Qnum r))).
    { rewrite INR_IZR_INZ, Z2Nat.id by assumption. unfold Q2R. rewrite B2. field. }
    rewrite <- R2, R1. field. lra.
  Qed.

  (* u is in t + [lo, hi]: its step is among those of the window, and each of these has such a u *)
  Definition among (a : nat) (b : option nat) (k j : nat) : Prop :=
    (k + a <= j)%nat /\ match b with None => True | Some b => (j <= k + b)%nat end.
  Definition window (lo : term) (hi : option term) (a : nat) (b : option nat) : Prop :=
    steps lo = Some a /\ match hi, b with None, None => True | Some h, Some b => steps h = Some b | _, _ => False end.
  Lemma scaled t u n : t + INR n * Q2R (dt T) <= u <-> t / Q2R (dt T) + INR n <= u / Q2R (dt T).
  Proof.
    pose proof forward_R as F. split; intros H.
    - apply (Rmult_le_reg_r (Q2R (dt T))); [exact F|]. field_simplify; lra.
    - apply (Rmult_le_compat_r (Q2R (dt T))) in H; [|lra]. field_simplify in H; lra.
  Qed.
  Lemma scaled' t u n : u <= t + INR n * Q2R (dt T) <-> u / Q2R (dt T) <= t / Q2R (dt T) + INR n.
  Proof.
    pose proof forward_R as F. split; intros H.
    - apply (Rmult_le_reg_r (Q2R (dt T))); [exact F|]. field_simplify; lra.
    - apply (Rmult_le_compat_r (Q2R (dt T))) in H; [|lra]. field_simplify in H; lra.
  Qed.
  Lemma within_means lo hi a b t u : window lo hi a b -> within W t lo hi u <->
    t / Q2R (dt T) + INR a <= u / Q2R (dt T) /\
    match b with None => True | Some b => u / Q2R (dt T) <= t / Q2R (dt T) + INR b end.
  Proof.
    intros [A B]. unfold within. rewrite (steps_mean lo a t A), scaled.
    destruct hi as [h|], b as [b|]; try contradiction; [|tauto]. rewrite (steps_mean h b t B), scaled'. tauto.
  Qed.
  Lemma INR_less j k : INR j < INR k + 1 -> (j <= k)%nat.
  Proof. intros H. rewrite <- S_INR in H. apply INR_lt in H. lia. Qed.
  Lemma step_among lo hi a b k t u : window lo hi a b -> inside k t -> within W t lo hi u ->
    exists j, inside j u /\ among a b k j.
  Proof.
    intros H I L. apply (within_means _ _ _ _ _ _ H) in L as [L1 L2]. destruct I as [I1 I2].
    pose proof (pos_INR k). pose proof (pos_INR a).
    destruct (has_piece u) as [j [J1 J2]]; [lra|]. exists j. split; [split; assumption|]. split.
    - apply INR_less. rewrite plus_INR. lra.
    - destruct b as [b|]; [|trivial]. apply INR_less. rewrite plus_INR. lra.
  Qed.
  Lemma at_time x : exists u, u / Q2R (dt T) = x.
  Proof. exists (x * Q2R (dt T)). pose proof forward_R. field. lra. Qed.
  (* a time in step j at the same place in its step *)
  Lemma among_step lo hi a b k t j : window lo hi a b -> inside k t -> among a b k j ->
    exists u, inside j u /\ within W t lo hi u.
  Proof.
    intros H [I1 I2] [A B]. destruct (at_time (t / Q2R (dt T) + (INR j - INR k))) as [u U]. exists u.
    apply le_INR in A. rewrite plus_INR in A. split; [split; lra|].
    apply (within_means _ _ _ _ _ _ H). split; [lra|].
    destruct b as [b|]; [|trivial]. apply le_INR in B. rewrite plus_INR in B. lra.
  Qed.

  Lemma span_window lo hi w : span lo hi = Some w -> exists b, window lo hi (fst w) b /\
    forall k (P : nat -> Prop), (forall i j, (final <= i <= j)%nat -> P j -> P i) ->
      (exists j, among (fst w) b k j /\ P j) <->
      match snd w with None => False | Some n => exists m, (m <= n)%nat /\ P (k + fst w + m)%nat end.
  Proof.
    unfold span. destruct (steps lo) as [a|] eqn:A; [|discriminate]. destruct hi as [h|].
    - destruct (steps h) as [b|] eqn:B; [|discriminate]. intros [= <-]. exists (Some b). split; [split; assumption|].
      cbn [fst snd]. intros k P L. destruct (Nat.leb_spec a b).
      + split.
        * intros [j [[J1 J2] J]]. destruct (Nat.le_gt_cases (j - (k + a)) final).
          -- exists (j - (k + a))%nat. split; [lia|]. replace (k + a + (j - (k + a)))%nat with j by lia. exact J.
          -- exists (Nat.min (b - a) final). split; [lia|]. apply (L _ j); [lia|exact J].
        * intros [m [M J]]. exists (k + a + m)%nat. split; [split; lia|exact J].
      + split; [intros [j [[J1 J2] _]]; lia|contradiction].
    - intros [= <-]. exists None. split; [split; [exact A|exact I]|]. cbn [fst snd]. intros k P L. split.
      + intros [j [[J1 _] J]]. destruct (Nat.le_gt_cases (j - (k + a)) final).
        * exists (j - (k + a))%nat. split; [lia|]. replace (k + a + (j - (k + a)))%nat with j by lia. exact J.
        * exists final. split; [lia|]. apply (L _ j); [lia|exact J].
      + intros [m [M J]]. exists (k + a + m)%nat. split; [split; [lia|exact I]|exact J].
  Qed.

  Lemma exists_below n (g : nat -> bool) :
    existsb g (seq 0 (S n)) = true <-> exists m, (m <= n)%nat /\ g m = true.
  Proof.
    rewrite existsb_exists. split; intros [m [M G]]; exists m; (split; [|exact G]).
    - apply in_seq in M. lia.
    - apply in_seq. lia.
  Qed.
  Lemma forall_below n (g : nat -> bool) : forallb g (seq 0 n) = true <-> forall m, (m < n)%nat -> g m = true.
  Proof.
    rewrite forallb_forall. split; intros H m M; apply H; [apply in_seq; lia|apply in_seq in M; lia].
  Qed.
  Lemma late_true v i j : (final <= i <= j)%nat -> at_ v j = true -> at_ v i = true.
  Proof. intros H. rewrite (at_late v j), (at_late v i) by lia. trivial. Qed.

  Lemma some_of_right lo hi w f v : span lo hi = Some w -> right f v ->
    right (Eventually lo hi f) (tabled (some_of v (fst w) (snd w))).
  Proof.
    intros S R k t I. rewrite at_tabled. destruct (span_window lo hi w S) as [b [H L]].
    specialize (L k (fun j => at_ v j = true) (fun i j => late_true v i j)).
    transitivity (exists j, among (fst w) b k j /\ at_ v j = true).
    - cbn [holds]. split.
      + intros [u [U F]]. destruct (step_among lo hi _ b k t u H I U) as [j [J A]].
        exists j. split; [exact A|]. apply (R j u J), F.
      + intros [j [A J]]. destruct (among_step lo hi _ b k t j H I A) as [u [U Q]].
        exists u. split; [exact Q|]. apply (R j u U), J.
    - rewrite L. unfold some_of. destruct (snd w) as [n|]; [|split; [contradiction|discriminate]].
      rewrite exists_below. split; intros [m [M J]]; exists m; (split; [exact M|]);
        rewrite <- Nat.add_assoc, at_moved, Nat.add_assoc in *; exact J.
  Qed.
  Lemma all_is_not_some v a n k : all_of v a n k = negb (some_of (tabled (fun k => negb (at_ v k))) a n k).
  Proof.
    unfold all_of, some_of. destruct n as [n|]; [|reflexivity].
    induction (seq 0 (S n)) as [|m l IH]; [reflexivity|]. cbn [forallb existsb].
    rewrite IH, negb_orb, at_tabled, at_least_min, negb_involutive. reflexivity.
  Qed.
  Lemma not_right f v : right f v -> right (Not f) (tabled (fun k => negb (at_ v k))).
  Proof.
    intros R k t I. rewrite at_tabled, at_least_min, negb_true_iff. cbn [holds]. rewrite (R k t I).
    destruct (at_ v k); split; intros H; congruence || tauto.
  Qed.
  Lemma all_of_right lo hi w f v : span lo hi = Some w -> right f v ->
    right (Always lo hi f) (tabled (all_of v (fst w) (snd w))).
  Proof.
    intros S R k t I. pose proof (some_of_right lo hi w _ _ S (not_right f v R) k t I) as E.
    rewrite at_tabled in *. rewrite all_is_not_some, negb_true_iff, <- not_true_iff_false, <- E. cbn [holds]. split.
    - intros H [u [U N]]. exact (N (H u U)).
    - intros H u U. destruct (has_piece u) as [j J].
      { destruct (span_window lo hi w S) as [b [X _]]. destruct (step_among lo hi _ b k t u X I U) as [j [[J _] _]].
        pose proof (pos_INR j). lra. }
      apply (R j u J). destruct (at_ v j) eqn:A; [reflexivity|]. exfalso. apply H. exists u. split; [exact U|].
      intros F. apply (R j u J) in F. congruence.
  Qed.
  Lemma until_of_right lo hi w f g u v : span lo hi = Some w -> right f u -> right g v ->
    right (Until f lo hi g) (tabled (until_of u v (fst w) (snd w))).
  Proof.
    intros S F G k t I. rewrite at_tabled. destruct (span_window lo hi w S) as [b [H L]].
    set (a := fst w) in *.
    specialize (L k (fun j => at_ v j = true /\ forall i, (k + a <= i < j)%nat -> at_ u i = true)).
    transitivity (exists j, among a b k j /\ at_ v j = true /\ forall i, (k + a <= i < j)%nat -> at_ u i = true).
    - cbn [holds]. assert (LO : number W t lo = INR a * Q2R (dt T)) by (apply steps_mean, H). split.
      + intros [x [X [Gx Fx]]]. destruct (step_among lo hi _ b k t x H I X) as [j [J A]].
        exists j. split; [exact A|]. split; [apply (G j x J), Gx|]. intros i [I1 I2].
        destruct (at_time (t / Q2R (dt T) + (INR i - INR k))) as [y Y].
        assert (IY : inside i y). { destruct I. split; lra. }
        apply (F i y IY), Fx. rewrite LO. split.
        * apply scaled. apply le_INR in I1. rewrite plus_INR in I1. lra.
        * pose proof forward_R as P. apply Rmult_lt_reg_r with (/ Q2R (dt T)); [apply Rinv_0_lt_compat, P|].
          change (y / Q2R (dt T) < x / Q2R (dt T)). destruct IY as [_ Y2], J as [J1 _].
          assert (I3 : (i + 1 <= j)%nat) by lia. apply le_INR in I3. rewrite plus_INR in I3. simpl (INR 1) in I3. lra.
      + intros [j [A [Gj Fj]]].
        assert (E : exists x, inside j x /\ within W t lo hi x /\
          forall y, t + number W t lo <= y < x -> exists i, inside i y /\ (k + a <= i < j)%nat).
        { destruct (Nat.eq_dec j (k + a)) as [->|N].
          - destruct (at_time (t / Q2R (dt T) + INR a)) as [x X]. exists x. destruct I as [I1 I2].
            split; [split; rewrite plus_INR; lra|]. split.
            + apply (within_means _ _ _ _ _ _ H). split; [lra|]. destruct A as [_ A]. destruct b as [b|]; [|trivial].
              apply le_INR in A. rewrite !plus_INR in A. lra.
            + intros y [Y1 Y2]. exfalso. rewrite LO in Y1. apply scaled in Y1. pose proof forward_R as P.
              apply (Rmult_lt_compat_r (/ Q2R (dt T))) in Y2; [|apply Rinv_0_lt_compat, P].
              change (y / Q2R (dt T) < x / Q2R (dt T)) in Y2. lra.
          - destruct A as [A1 A2]. assert (A3 : (k + a + 1 <= j)%nat) by lia. apply le_INR in A3.
            rewrite !plus_INR in A3. simpl (INR 1) in A3. destruct I as [I1 I2].
            destruct (at_time (INR j)) as [x X]. exists x. split; [split; lra|]. split.
            + apply (within_means _ _ _ _ _ _ H). split; [lra|]. destruct b as [b|]; [|trivial].
              apply le_INR in A2. rewrite plus_INR in A2. lra.
            + intros y [Y1 Y2]. rewrite LO in Y1. apply scaled in Y1. pose proof forward_R as P.
              apply (Rmult_lt_compat_r (/ Q2R (dt T))) in Y2; [|apply Rinv_0_lt_compat, P].
              change (y / Q2R (dt T) < x / Q2R (dt T)) in Y2. pose proof (pos_INR k). pose proof (pos_INR a).
              destruct (has_piece y) as [i [J1 J2]]; [lra|]. exists i. split; [split; assumption|]. split.
              * apply INR_less. rewrite plus_INR. lra.
              * apply INR_lt. lra. }
        destruct E as [x [X [Wx Y]]]. exists x. split; [exact Wx|]. split; [apply (G j x X), Gj|].
        intros y Hy. destruct (Y y Hy) as [i [IY Hi]]. apply (F i y IY), Fj, Hi.
    - rewrite L.
      + unfold until_of. destruct (snd w) as [n|]; [|split; [contradiction|discriminate]].
        rewrite exists_below. split; intros [m [M J]]; exists m; (split; [exact M|]).
        * destruct J as [J1 J2]. apply andb_true_intro. split.
          -- rewrite <- Nat.add_assoc, at_moved, Nat.add_assoc. exact J1.
          -- apply forall_below. intros i Hi. rewrite <- Nat.add_assoc, at_moved, Nat.add_assoc. apply J2. lia.
        * apply andb_prop in J as [J1 J2]. rewrite <- Nat.add_assoc, at_moved, Nat.add_assoc in J1. split; [exact J1|].
          intros i Hi. apply forall_below with (m := (i - (k + a))%nat) in J2; [|lia].
          rewrite <- Nat.add_assoc, at_moved in J2. replace (k + (a + (i - (k + a))))%nat with i in J2 by lia. exact J2.
      + intros i j Hij [J1 J2]. split; [apply (late_true v i j Hij J1)|]. intros h Hh. apply J2. lia.
  Qed.

  Lemma whole_nth l v : gathered l = Some v -> forall k, (k < List.length l)%nat -> nth k l None = Some (nth k v false).
  Proof.
    revert v. induction l as [|[x|] l IH]; intros v H k K; cbn in *; try discriminate; [lia|].
    destruct (gathered l) as [v'|]; [|discriminate]. injection H as <-.
    destruct k as [|k]; [reflexivity|]. cbn [nth]. apply IH; [reflexivity|lia].
  Qed.
  Lemma later_value k t x : inside k t -> forall q, rational (Nat.min k final) x = Some q -> rational k x = Some q.
  Proof.
    intros _ q. assert (E : rational (Nat.min k final) x = rational k x).
    { induction x; cbn [rational]; try reflexivity; try (rewrite IHx1, IHx2; reflexivity).
      - unfold step. do 2 f_equal. lia.
      - rewrite IHx. reflexivity. }
    rewrite E. trivial.
  Qed.
  Lemma later_side k t s x : inside k t -> extended_rational (Nat.min k final) s = Some x -> extended_rational k s = Some x.
  Proof.
    intros I H. destruct s as [y|y]; cbn in *; destruct (rational (Nat.min k final) y) as [q|] eqn:E; try discriminate;
      rewrite (later_value k t y I q E); exact H.
  Qed.

  Theorem reads_right f : forall v, reads f = Some v -> right f v.
  Proof.
    induction f as [b|l o r| | | |f IH|f IHf g IHg|f IHf g IHg|f IHf lo hi g IHg|lo hi f IH|lo hi f IH];
      intros v H; cbn [reads] in H; try discriminate.
    - injection H as <-. intros k t _. rewrite at_tabled. reflexivity.
    - intros k t I. pose proof (whole_nth _ _ H (Nat.min k final)) as N.
      rewrite map_length, seq_length in N. specialize (N ltac:(lia)).
      rewrite (nth_indep _ None ((fun k => both (decides o) (extended_rational k l) (extended_rational k r)) 0%nat)) in N
        by (rewrite map_length, seq_length; lia).
      rewrite (map_nth (fun k => both (decides o) (extended_rational k l) (extended_rational k r))), seq_nth in N by lia.
      cbn [plus] in N. destruct (extended_rational (Nat.min k final) l) as [x|] eqn:X; [|discriminate].
      destruct (extended_rational (Nat.min k final) r) as [y|] eqn:Y; [|discriminate]. injection N as N.
      cbn [holds]. rewrite (extended_means k t l x I (later_side k t l x I X)).
      rewrite (extended_means k t r y I (later_side k t r y I Y)). unfold at_. rewrite <- N. symmetry. apply decides_means.
    - destruct (reads f) as [u|]; [|discriminate]. injection H as <-. apply not_right, IH. reflexivity.
    - destruct (reads f) as [u|], (reads g) as [w|]; try discriminate. injection H as <-. intros k t I.
      rewrite at_tabled, !at_least_min, andb_true_iff. cbn [holds].
      rewrite (IHf u eq_refl k t I), (IHg w eq_refl k t I). reflexivity.
    - destruct (reads f) as [u|], (reads g) as [w|]; try discriminate. injection H as <-. intros k t I.
      rewrite at_tabled, !at_least_min, orb_true_iff. cbn [holds].
      rewrite (IHf u eq_refl k t I), (IHg w eq_refl k t I). reflexivity.
    - destruct (span lo hi) as [w|] eqn:S; [|discriminate].
      destruct (reads f) as [u|], (reads g) as [x|]; try discriminate. injection H as <-.
      apply (until_of_right lo hi w f g u x S); auto.
    - destruct (span lo hi) as [w|] eqn:S; [|discriminate]. destruct (reads f) as [u|]; try discriminate.
      injection H as <-. apply (some_of_right lo hi w f u S); auto.
    - destruct (span lo hi) as [w|] eqn:S; [|discriminate]. destruct (reads f) as [u|]; try discriminate.
      injection H as <-. apply (all_of_right lo hi w f u S); auto.
  Qed.
End Reads.

(* What is answered is so: in both directions. *)
Theorem answer_right T f b : (0 < dt T)%Q -> answer T f = Some b ->
  forall named bound, holds (world_of T) named bound 0 f <-> b = true.
Proof.
  intros P H named bound. unfold answer in H. destruct (reads T f) as [v|] eqn:R; [|discriminate]. injection H as <-.
  apply (reads_right T P named bound f v R 0%nat 0). unfold inside, Rdiv. rewrite Rmult_0_l. simpl. lra.
Qed.
