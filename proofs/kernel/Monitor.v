(* The bit-parallel monitor.  NOT TRUSTED: proved, and run by tests alone.

   `value` and `answer` are the algorithm of semantics/sampled/semantics.py and boolean.py on numbers of any size:
   one number holds a sample of all traces, bit b that of trace b.  `value_right`: each bit inside a trace is what
   Recorded.v says, for all formulas, lengths and windows.  `answer_right`: so is each answer.  `decided`: an answer
   holds for every continuation of the recording.  The tests run `value` and compare all words with Python's. *)
From Coq Require Import Reals QArith Qreals String List Bool NArith Arith Lia Lra.
From Roadproof Require Import Meaning.
From Roadproof Require Import Recorded.
Import ListNotations.
Open Scope nat_scope.

(* --- arrays: row k holds sample k ---------------------------------------------------------------------------- *)

Section Arrays.
  Context {V : Type}.

  (* Row k of the result is row k + steps, and padding beyond the last. *)
  Definition shift (values : list V) (steps : nat) (padding : V) : list V :=
    skipn steps values ++ repeat padding (Nat.min steps (List.length values)).
  Fixpoint zip (op : V -> V -> V) (l m : list V) : list V :=
    match l, m with x :: l, y :: m => op x y :: zip op l m | _, _ => [] end.
  (* op of values and of what is `steps` later, in one pass *)
  Definition join_shifted (op : V -> V -> V) (values other : list V) (steps : nat) (padding : V) : list V :=
    let kept := List.length values - steps in
    zip op (firstn kept values) (skipn steps other) ++ map (fun v => op v padding) (skipn kept values).
  Definition samples_in_window (low : nat) (high : option nat) (samples : nat) : nat :=
    match high with None => samples + 1 | Some h => Nat.min (h - low) samples + 1 end.

  (* The loops need at most `fuel` rounds. *)
  Fixpoint widened (fuel : nat) (op : V -> V -> V) (window : list V) (width wanted : nat) (padding : V) : list V :=
    match fuel with
    | O => window
    | S fuel =>
        if width <? wanted then
          let step := Nat.min width (wanted - width) in
          widened fuel op (join_shifted op window window step padding) (width + step) wanted padding
        else window
    end.
  Definition extremum (op : V -> V -> V) (values : list V) (low : nat) (high : option nat) (padding : V) : list V :=
    let wanted := samples_in_window low high (List.length values) in
    shift (widened wanted op values 1 wanted padding) low padding.

  Fixpoint reaching (fuel : nat) (join meet : V -> V -> V) (held found kept : list V) (width wanted : nat)
    (padding : V) : list V :=
    match fuel with
    | O => found
    | S fuel =>
        if width <? wanted then
          let step := Nat.min width (wanted - width) in
          let start := if step =? width then kept else extremum meet held 0 (Some (step - 1)) padding in
          let later := join_shifted meet start found step padding in
          let found := zip join found later in
          let width := width + step in
          let kept := if width <=? wanted - width then join_shifted meet kept kept step padding else kept in
          reaching fuel join meet held found kept width wanted padding
        else found
    end.
  Definition until (join meet : V -> V -> V) (held reached : list V) (low : nat) (high : option nat) (padding : V) :=
    let wanted := samples_in_window low high (List.length held) in
    shift (reaching wanted join meet held reached held 1 wanted padding) low padding.

  (* --- what they compute, seen through any map to truth values that turns op into `or` *)
  Lemma nth_shift l s p k : nth k (shift l s p) p = nth (k + s) l p.
  Proof.
    unfold shift. destruct (Nat.le_gt_cases (List.length l) (k + s)) as [H|H].
    - rewrite (nth_overflow l) by lia. destruct (Nat.le_gt_cases (List.length (skipn s l)) k) as [K|K].
      + rewrite app_nth2 by exact K. apply nth_repeat.
      + rewrite skipn_length in K. lia.
    - rewrite app_nth1 by (rewrite skipn_length; lia). clear H. revert l k. induction s as [|s IH]; intros l k.
      + rewrite Nat.add_0_r. reflexivity.
      + destruct l as [|x l]; cbn [skipn]; [destruct k; reflexivity|]. rewrite IH, Nat.add_succ_r. reflexivity.
  Qed.
  Lemma length_shift l s p : List.length (shift l s p) = List.length l.
  Proof. unfold shift. rewrite app_length, skipn_length, repeat_length. lia. Qed.
  Lemma length_zip op l m : List.length (zip op l m) = Nat.min (List.length l) (List.length m).
  Proof. revert m. induction l as [|x l IH]; intros [|y m]; cbn; try reflexivity. rewrite IH. reflexivity. Qed.
  Lemma nth_zip op l m k d : k < List.length l -> k < List.length m -> nth k (zip op l m) d = op (nth k l d) (nth k m d).
  Proof.
    revert m k. induction l as [|x l IH]; intros [|y m] [|k] L M; cbn in *; try lia; [reflexivity|]. apply IH; lia.
  Qed.
  Lemma nth_firstn_less (l : list V) n k d : k < n -> nth k (firstn n l) d = nth k l d.
  Proof. revert n k. induction l as [|x l IH]; intros [|n] [|k] H; cbn; try reflexivity; try lia. apply IH. lia. Qed.
  Lemma nth_skipn_later (l : list V) n k d : nth k (skipn n l) d = nth (n + k) l d.
  Proof. revert l. induction n as [|n IH]; intros [|x l]; cbn; try reflexivity; [destruct k; reflexivity|apply IH]. Qed.
  Lemma length_join_shifted op l m s p :
    List.length m = List.length l -> List.length (join_shifted op l m s p) = List.length l.
  Proof.
    intros E. unfold join_shifted. rewrite app_length, length_zip, firstn_length, !skipn_length, map_length, skipn_length. lia.
  Qed.
  Lemma nth_join_shifted op l m s p k : List.length m = List.length l -> k < List.length l ->
    nth k (join_shifted op l m s p) p = op (nth k l p) (nth (k + s) m p).
  Proof.
    intros E K. unfold join_shifted. set (n := List.length l - s).
    assert (Z : List.length (zip op (firstn n l) (skipn s m)) = n).
    { rewrite length_zip, firstn_length, skipn_length. unfold n. lia. }
    destruct (Nat.lt_ge_cases k n) as [H|H].
    - rewrite app_nth1 by lia. rewrite nth_zip; [|rewrite firstn_length; lia|rewrite skipn_length; lia].
      rewrite nth_firstn_less, nth_skipn_later by exact H. do 2 f_equal. lia.
    - rewrite app_nth2 by lia. rewrite Z.
      rewrite (nth_indep _ p (op p p)) by (rewrite map_length, skipn_length; lia).
      rewrite (map_nth (fun v => op v p)), nth_skipn_later.
      replace (n + (k - n)) with k by lia. rewrite (nth_overflow m) by (unfold n in H; lia). reflexivity.
  Qed.

  Section Through.
    Variables (h : V -> bool) (op : V -> V -> V).
    Hypothesis turns : forall x y, h (op x y) = h x || h y.

    Lemma through_join_shifted l m s p k : List.length m = List.length l ->
      h (nth k (join_shifted op l m s p) p) = h (nth k l p) || h (nth (k + s) m p).
    Proof.
      intros E. destruct (Nat.lt_ge_cases k (List.length l)) as [K|K].
      - rewrite nth_join_shifted by assumption. apply turns.
      - rewrite !nth_overflow; rewrite ?length_join_shifted; try lia; destruct (h p); reflexivity.
    Qed.
    Lemma length_widened fuel l width wanted p : List.length (widened fuel op l width wanted p) = List.length l.
    Proof.
      revert l width. induction fuel as [|fuel IH]; intros l width; cbn [widened]; [reflexivity|].
      destruct (width <? wanted); [|reflexivity]. rewrite IH. apply length_join_shifted. reflexivity.
    Qed.
    Definition some_within (l : list V) (p : V) (k n : nat) : Prop := exists m, m < n /\ h (nth (k + m) l p) = true.
    Lemma widened_right l p wanted fuel : forall w width, 1 <= width <= wanted -> wanted <= fuel + width ->
      List.length w = List.length l ->
      (forall k, h (nth k w p) = true <-> some_within l p k width) ->
      forall k, h (nth k (widened fuel op w width wanted p) p) = true <-> some_within l p k wanted.
    Proof.
      induction fuel as [|fuel IH]; intros w width B F E I k; cbn [widened].
      { replace wanted with width by lia. apply I. }
      destruct (Nat.ltb_spec width wanted) as [L|L]; [|replace wanted with width by lia; apply I].
      cbv zeta. set (step := Nat.min width (wanted - width)).
      apply IH; [unfold step; lia|unfold step; lia|rewrite length_join_shifted; auto|].
      clear k. intros k. rewrite through_join_shifted by reflexivity. rewrite orb_true_iff, !I. unfold some_within. split.
      - intros [[m [M H]]|[m [M H]]]; [exists m; split; [lia|exact H]|].
        exists (step + m). split; [lia|]. rewrite Nat.add_assoc. exact H.
      - intros [m [M H]]. destruct (Nat.lt_ge_cases m width) as [S|S]; [left; exists m; auto|].
        right. exists (m - step). split; [lia|].
        replace (k + step + (m - step)) with (k + m) by (unfold step in *; lia). exact H.
    Qed.
    Lemma extremum_right l low high p k : h (nth k (extremum op l low high p) p) = true <->
      some_within l p (k + low) (samples_in_window low high (List.length l)).
    Proof.
      unfold extremum. cbv zeta. rewrite nth_shift. set (wanted := samples_in_window _ _ _).
      assert (1 <= wanted). { unfold wanted, samples_in_window. destruct high; lia. }
      apply widened_right; try lia. intros j. unfold some_within. split.
      - intros H1. exists 0. rewrite Nat.add_0_r. auto.
      - intros [m [M H1]]. replace (j + m) with j in H1 by lia. exact H1.
    Qed.
    Lemma length_extremum l low high p : List.length (extremum op l low high p) = List.length l.
    Proof. unfold extremum. cbv zeta. rewrite length_shift, length_widened. reflexivity. Qed.
  End Through.

  Section ThroughBoth.
    Variables (h : V -> bool) (join meet : V -> V -> V).
    Hypothesis joins : forall x y, h (join x y) = h x || h y.
    Hypothesis meets : forall x y, h (meet x y) = h x && h y.

    (* meet is join seen through `not` *)
    Lemma meets_not x y : negb (h (meet x y)) = negb (h x) || negb (h y).
    Proof. rewrite meets. apply negb_andb. Qed.
    Lemma always_right l low high p k : h (nth k (extremum meet l low high p) p) = true <->
      forall m, m < samples_in_window low high (List.length l) -> h (nth (k + low + m) l p) = true.
    Proof.
      pose proof (extremum_right (fun x => negb (h x)) meet meets_not l low high p k) as E. cbv beta in E.
      unfold some_within in E. destruct (h (nth k _ p)).
      - cbn in E. split; [|reflexivity]. intros _ m M. destruct (h (nth (k + low + m) l p)) eqn:H; [reflexivity|].
        assert (false = true); [|discriminate]. apply E. exists m. rewrite H. auto.
      - split; [discriminate|]. intros H. destruct (proj1 E eq_refl) as [m [M N]]. rewrite H in N by exact M. discriminate.
    Qed.
    Lemma through_meet_shifted l m s p k : List.length m = List.length l ->
      h (nth k (join_shifted meet l m s p) p) = h (nth k l p) && h (nth (k + s) m p).
    Proof.
      intros E. pose proof (through_join_shifted (fun x => negb (h x)) meet meets_not l m s p k E) as H.
      cbv beta in H. destruct (h (nth k _ p)), (h (nth k l p)), (h (nth (k + s) m p)); cbn in *; congruence.
    Qed.

    Definition all_within (l : list V) (p : V) (k n : nat) : Prop := forall m, m < n -> h (nth (k + m) l p) = true.
    Definition reach (l r : list V) (p : V) (k n : nat) : Prop :=
      exists m, m < n /\ h (nth (k + m) r p) = true /\ all_within l p k m.
    Lemma reach_more l r p k n m : m <= n ->
      reach l r p k (n + m) <-> reach l r p k n \/ (all_within l p k m /\ reach l r p (k + m) n).
    Proof.
      intros L. split.
      - intros [j [J [R A]]]. destruct (Nat.lt_ge_cases j n) as [H|H]; [left; exists j; auto|]. right. split.
        + intros i I. apply A. lia.
        + exists (j - m). split; [lia|]. split.
          * replace (k + m + (j - m)) with (k + j) by lia. exact R.
          * intros i I. replace (k + m + i) with (k + (m + i)) by lia. apply A. lia.
      - intros [[j [J H]]|[A [j [J [R B]]]]]; [exists j; split; [lia|exact H]|].
        exists (m + j). split; [lia|]. split; [rewrite Nat.add_assoc; exact R|].
        intros i I. destruct (Nat.lt_ge_cases i m) as [H|H]; [apply A, H|].
        replace (k + i) with (k + m + (i - m)) by lia. apply B. lia.
    Qed.
    Lemma reaching_right held reached p wanted fuel : List.length reached = List.length held ->
      wanted <= List.length held + 1 -> forall found kept width, 1 <= width <= wanted -> wanted <= fuel + width ->
      List.length found = List.length held -> List.length kept = List.length held ->
      (forall k, h (nth k found p) = true <-> reach held reached p k width) ->
      (width <= wanted - width -> forall k, h (nth k kept p) = true <-> all_within held p k width) ->
      forall k, h (nth k (reaching fuel join meet held found kept width wanted p) p) = true
                <-> reach held reached p k wanted.
    Proof.
      intros ER W. induction fuel as [|fuel IH]; intros found kept width B F EF EK IF IK k; cbn [reaching].
      { replace wanted with width by lia. apply IF. }
      destruct (Nat.ltb_spec width wanted) as [L|L]; [|replace wanted with width by lia; apply IF].
      cbv zeta. set (step := Nat.min width (wanted - width)).
      set (start := if step =? width then kept else extremum meet held 0 (Some (step - 1)) p).
      assert (ES : List.length start = List.length held).
      { unfold start. destruct (step =? width); [exact EK|]. apply length_extremum. }
      assert (IS : forall k, h (nth k start p) = true <-> all_within held p k step).
      { clear k. intros k. unfold start. destruct (Nat.eqb_spec step width) as [E|E].
        - rewrite E. apply IK. unfold step in E. lia.
        - rewrite always_right, Nat.add_0_r. unfold samples_in_window.
          replace (Nat.min (step - 1 - 0) (List.length held) + 1) with step by (unfold step in *; lia). reflexivity. }
      assert (EL : List.length (join_shifted meet start found step p) = List.length held).
      { rewrite length_join_shifted; congruence. }
      apply IH; clear IH.
      - unfold step. lia.
      - unfold step. lia.
      - rewrite length_zip. lia.
      - destruct (_ <=? _); [|exact EK]. rewrite length_join_shifted; [exact EK|reflexivity].
      - clear k. intros k. rewrite (reach_more _ _ _ _ width step) by (unfold step; lia).
        rewrite <- IF, <- IS, <- IF, <- andb_true_iff, <- through_meet_shifted by congruence.
        rewrite <- orb_true_iff. destruct (Nat.lt_ge_cases k (List.length held)) as [K|K].
        + rewrite nth_zip by lia. rewrite joins. reflexivity.
        + rewrite !nth_overflow; rewrite ?length_zip; try lia; destruct (h p); cbn; tauto.
      - destruct (Nat.leb_spec (width + step) (wanted - (width + step))) as [M|M]; [|lia]. intros _. clear k. intros k.
        assert (S : step = width) by (unfold step in *; lia).
        rewrite through_meet_shifted by reflexivity. rewrite andb_true_iff, !IK by lia. rewrite S. split.
        + intros [A A'] m Hm. destruct (Nat.lt_ge_cases m width) as [N|N]; [apply A, N|].
          replace (k + m) with (k + width + (m - width)) by lia. apply A'. lia.
        + intros A. split; intros m Hm; [apply A; lia|]. rewrite <- Nat.add_assoc. apply A. lia.
    Qed.
    Lemma until_right held reached low high p k : List.length reached = List.length held ->
      h (nth k (until join meet held reached low high p) p) = true <->
      reach held reached p (k + low) (samples_in_window low high (List.length held)).
    Proof.
      intros E. unfold until. cbv zeta. rewrite nth_shift. set (wanted := samples_in_window _ _ _).
      assert (1 <= wanted <= List.length held + 1). { unfold wanted, samples_in_window. destruct high; lia. }
      apply reaching_right; try lia.
      - intros j. unfold reach, all_within. split.
        + intros H1. exists 0. rewrite Nat.add_0_r. split; [lia|]. split; [exact H1|]. intros; lia.
        + intros [m [M [H1 _]]]. replace (j + m) with j in H1 by lia. exact H1.
      - intros _ j. unfold all_within. split.
        + intros H1 m M. replace (j + m) with j by lia. exact H1.
        + intros H1. rewrite <- (Nat.add_0_r j). apply H1. lia.
    Qed.
    Lemma length_until held reached low high p : List.length reached = List.length held ->
      List.length (until join meet held reached low high p) = List.length held.
    Proof.
      intros E. unfold until. cbv zeta. rewrite length_shift. set (wanted := samples_in_window _ _ _). clearbody wanted.
      cut (forall fuel found kept width, List.length found = List.length held -> List.length kept = List.length held ->
        List.length (reaching fuel join meet held found kept width wanted p) = List.length held).
      { intros H. apply H; auto. }
      induction fuel as [|fuel IH]; intros found kept width EF EK; cbn [reaching]; [exact EF|].
      destruct (width <? wanted); [|exact EF]. cbv zeta. apply IH.
      - set (start := if _ =? width then kept else _).
        assert (S : List.length start = List.length held).
        { unfold start. destruct (_ =? _); [exact EK|apply length_extremum]. }
        rewrite length_zip, length_join_shifted by congruence. lia.
      - destruct (_ <=? _); [|exact EK]. rewrite length_join_shifted; auto.
    Qed.
  End ThroughBoth.
End Arrays.

(* --- the algorithm ------------------------------------------------------------------------------------------- *)

(* Bit b is the b-th truth value of the list. *)
Fixpoint packed (l : list bool) : N := match l with [] => 0 | x :: l => 2 * packed l + N.b2n x end%N.
(* All bits of the samples that belong to their traces, or None where that is every sample *)
Definition inside_of (lengths : list nat) (rows : nat) : option (list N) :=
  if forallb (Nat.eqb rows) lengths then None
  else Some (map (fun k => packed (map (fun n => k <? n) lengths)) (seq 0 rows)).

Section Words.
  Variable bits : N.                                        (* of a row: 64 for each machine word *)
  Variable rows : nat.                                      (* samples of the longest trace *)
  Variable lengths : list nat.                              (* samples of each trace *)
  Variable states : nat -> list N.                          (* truth of the i-th state formula *)

  Definition complement (x : N) : N := N.lnot x bits.
  Definition top : N := N.ones bits.
  Definition padding (v : view) (universal : bool) : N :=
    match v with Strong => 0%N | Weak => top | Clip => if universal then top else 0%N end.
  Definition padded (values : list N) (p : N) : list N :=
    match inside_of lengths rows with
    | None => values
    | Some l => if (p =? 0)%N then zip N.land values l else zip N.lor values (map complement l)
    end.
  Fixpoint value (v : view) (f : sampled) : list N :=
    match f with
    | Truth_ b => repeat (if b then top else 0%N) rows
    | State i => states i
    | Not_ f => map complement (value (opposite v) f)
    | And_ f g => zip N.land (value v f) (value v g)
    | Or_ f g => zip N.lor (value v f) (value v g)
    | Until_ f lo hi g =>
        let p := padding v false in until N.lor N.land (padded (value v f) p) (padded (value v g) p) lo hi p
    | Eventually_ lo hi f => let p := padding v false in extremum N.lor (padded (value v f) p) lo hi p
    | Always_ lo hi f => let p := padding v true in extremum N.land (padded (value v f) p) lo hi p
    end.
  (* The cache of Python keeps one value for all views of a formula without temporal operators. *)
  Fixpoint timeless (f : sampled) : bool :=
    match f with
    | Truth_ _ | State _ => true
    | Not_ f => timeless f
    | And_ f g | Or_ f g => timeless f && timeless g
    | Until_ _ _ _ _ | Eventually_ _ _ _ | Always_ _ _ _ => false
    end.
  Lemma same_in_all_views f : timeless f = true -> forall v w, value v f = value w f.
  Proof.
    induction f; cbn [timeless value]; intros T v w; try reflexivity; try discriminate.
    - f_equal. apply IHf, T.
    - apply andb_prop in T as [T1 T2]. f_equal; auto.
    - apply andb_prop in T as [T1 T2]. f_equal; auto.
  Qed.
  Definition answer (f : sampled) (k trace : nat) : verdict :=
    let bit v := N.testbit (nth k (value v f) 0%N) (N.of_nat trace) in
    if bit Strong then Yes else if bit Weak then Undecided else No.

  (* No interval is empty; the monitor refuses such formulas. *)
  Fixpoint proper (f : sampled) : bool :=
    let fine lo hi := match hi with None => true | Some b => lo <=? b end in
    match f with
    | Truth_ _ | State _ => true
    | Not_ f => proper f
    | And_ f g | Or_ f g => proper f && proper g
    | Until_ f lo hi g => fine lo hi && proper f && proper g
    | Eventually_ lo hi f | Always_ lo hi f => fine lo hi && proper f
    end.

  (* --- that it is right, for one trace *)
  Variables trace n : nat.
  Hypothesis here : nth_error lengths trace = Some n.
  Hypothesis shorter : n <= rows.
  Hypothesis room : (N.of_nat trace < bits)%N.
  Hypothesis whole : forall i, List.length (states i) = rows.
  Notation bit x := (N.testbit x (N.of_nat trace)).
  Notation h := (fun x => bit x).
  Definition truth_of (i k : nat) : Prop := bit (nth k (states i) 0%N) = true.
  Notation says := (recorded truth_of n).

  Lemma packed_right l j : N.testbit (packed l) (N.of_nat j) = nth j l false.
  Proof.
    revert j. induction l as [|x l IH]; intros j; [destruct j; apply N.bits_0|]. cbn [packed].
    destruct j as [|j]; [apply N.testbit_0_r|]. rewrite Nat2N.inj_succ, N.testbit_succ_r. apply IH.
  Qed.
  Lemma or_bits x y : bit (N.lor x y) = bit x || bit y. Proof. apply N.lor_spec. Qed.
  Lemma and_bits x y : bit (N.land x y) = bit x && bit y. Proof. apply N.land_spec. Qed.
  Lemma not_bits x : bit (complement x) = negb (bit x). Proof. apply N.lnot_spec_low, room. Qed.
  Lemma top_bits : bit top = true. Proof. apply N.ones_spec_low, room. Qed.
  Lemma inside_right l : inside_of lengths rows = Some l ->
    List.length l = rows /\ forall k, k < rows -> bit (nth k l 0%N) = (k <? n).
  Proof.
    unfold inside_of. destruct (forallb _ _); [discriminate|]. intros [= <-]. split; [rewrite map_length; apply seq_length|].
    intros k K. set (g := fun k => packed _).
    rewrite (nth_indep _ 0%N (g 0)) by (rewrite map_length, seq_length; exact K).
    rewrite (map_nth g), seq_nth by exact K. unfold g. rewrite packed_right. cbn [plus].
    apply (map_nth_error (fun n => k <? n)) in here. apply nth_error_nth, here.
  Qed.
  Lemma inside_everywhere : inside_of lengths rows = None -> n = rows.
  Proof.
    unfold inside_of. destruct (forallb _ _) eqn:E; [|discriminate]. intros _. rewrite forallb_forall in E.
    symmetry. apply Nat.eqb_eq, E. exact (nth_error_In _ _ here).
  Qed.

  Lemma padding_cases v u : padding v u = 0%N \/ padding v u = top.
  Proof. destruct v, u; auto. Qed.
  Lemma length_padded values p : List.length values = rows -> List.length (padded values p) = rows.
  Proof.
    intros E. unfold padded. destruct (inside_of lengths rows) as [l|] eqn:I; [|exact E].
    destruct (inside_right l I) as [L _]. destruct (_ =? _)%N; rewrite length_zip, ?map_length; lia.
  Qed.
  Lemma padded_right values v u k : List.length values = rows ->
    bit (nth k (padded values (padding v u)) (padding v u)) =
    if k <? n then bit (nth k values 0%N) else bit (padding v u).
  Proof.
    intros E. set (p := padding v u). destruct (Nat.lt_ge_cases k rows) as [K|K].
    2:{ rewrite nth_overflow by (rewrite length_padded; assumption). destruct (Nat.ltb_spec k n); [lia|reflexivity]. }
    unfold padded. destruct (inside_of lengths rows) as [l|] eqn:I.
    - destruct (inside_right l I) as [L B]. destruct (padding_cases v u) as [Z|Z]; fold p in Z; rewrite Z.
      + rewrite N.eqb_refl, nth_zip, and_bits, B by lia. destruct (k <? n); [apply andb_true_r|apply andb_false_r].
      + replace (top =? 0)%N with false.
        2:{ symmetry. apply N.eqb_neq. intros T. pose proof top_bits as H. rewrite T, N.bits_0 in H. discriminate. }
        rewrite nth_zip by (rewrite ?map_length; lia).
        rewrite or_bits, (nth_indep (map _ l) top (complement 0)) by (rewrite map_length; lia).
        rewrite map_nth, not_bits, B, (nth_indep values top 0%N) by lia. rewrite top_bits.
        destruct (k <? n); [apply orb_false_r|apply orb_true_r].
    - pose proof (inside_everywhere I). destruct (Nat.ltb_spec k n); [|lia]. rewrite (nth_indep values p 0%N) by lia. reflexivity.
  Qed.

  Lemma length_value v f : List.length (value v f) = rows.
  Proof.
    revert v. induction f; intros v; cbn [value]; cbv zeta.
    - apply repeat_length.
    - apply whole.
    - rewrite map_length. apply IHf.
    - rewrite length_zip, IHf1, IHf2. apply Nat.min_id.
    - rewrite length_zip, IHf1, IHf2. apply Nat.min_id.
    - rewrite length_until; rewrite !length_padded; auto.
    - rewrite length_extremum; apply length_padded; auto.
    - rewrite length_extremum; apply length_padded; auto.
  Qed.

  (* A window may be cut after so many samples that the last is after the end. *)
  Lemma cut_some k lo hi (P : nat -> Prop) : match hi with None => true | Some b => lo <=? b end = true ->
    (forall i j, n <= i <= j -> P j -> P i) ->
    (exists m, m < samples_in_window lo hi rows /\ P (k + lo + m)) <-> exists j, among k lo hi j /\ P j.
  Proof.
    intros B L. unfold samples_in_window, among. split.
    - intros [m [M H]]. exists (k + lo + m). split; [split; [lia|]|exact H].
      destruct hi as [b|]; [apply Nat.leb_le in B; lia|exact I].
    - intros [j [[J1 J2] H]]. destruct (Nat.le_gt_cases (j - (k + lo)) rows) as [R|R].
      + exists (j - (k + lo)). replace (k + lo + (j - (k + lo))) with j by lia. split; [destruct hi; lia|exact H].
      + exists rows. split; [destruct hi; lia|]. apply (L _ j); [lia|exact H].
  Qed.
  Lemma cut_all k lo hi (g : nat -> bool) : match hi with None => true | Some b => lo <=? b end = true ->
    (forall i j, n <= i <= j -> g j = g i) ->
    (forall m, m < samples_in_window lo hi rows -> g (k + lo + m) = true) <-> forall j, among k lo hi j -> g j = true.
  Proof.
    intros B L.
    pose proof (cut_some k lo hi (fun j => g j = false) B) as C. cbv beta in C.
    assert (D : forall i j, n <= i <= j -> g j = false -> g i = false) by (intros i j H <-; symmetry; auto).
    specialize (C D). split.
    - intros H j J. destruct (g j) eqn:G; [reflexivity|]. destruct (proj2 C) as [m [M N]]; [exists j; auto|].
      rewrite H in N by exact M. discriminate.
    - intros H m M. destruct (g _) eqn:G; [reflexivity|]. destruct (proj1 C) as [j [J N]]; [exists m; auto|].
      rewrite H in N by exact J. discriminate.
  Qed.

  Lemma after_end v k f : n <= k -> says v k f <-> after_the_end v.
  Proof. intros H. apply Nat.ltb_ge in H. destruct f; cbn [recorded]; rewrite H; reflexivity. Qed.
  Definition right (f : sampled) : Prop := forall v k, k < n -> bit (nth k (value v f) 0%N) = true <-> says v k f.
  Notation seen v u f k := (bit (nth k (padded (value v f) (padding v u)) (padding v u))).
  Lemma seen_late v u f i j : n <= i <= j -> seen v u f j = seen v u f i.
  Proof.
    intros H. rewrite !padded_right by apply length_value.
    destruct (Nat.ltb_spec i n), (Nat.ltb_spec j n); lia || reflexivity.
  Qed.
  Lemma some_seen v f k : right f -> seen v false f k = true <-> counts n v k /\ says v k f.
  Proof.
    intros R. rewrite padded_right by apply length_value. destruct (Nat.ltb_spec k n) as [K|K].
    - rewrite (R v k K). destruct v; cbn [counts]; tauto.
    - rewrite (after_end v k f K). destruct v; cbn [padding counts after_the_end]; rewrite ?N.bits_0, ?top_bits;
        intuition (lia || discriminate).
  Qed.
  Lemma all_seen v f k : right f -> seen v true f k = true <-> (counts n v k -> says v k f).
  Proof.
    intros R. rewrite padded_right by apply length_value. destruct (Nat.ltb_spec k n) as [K|K].
    - rewrite (R v k K). destruct v; cbn [counts]; tauto.
    - rewrite (after_end v k f K). destruct v; cbn [padding counts after_the_end]; rewrite ?N.bits_0, ?top_bits;
        intuition (lia || discriminate).
  Qed.
  Lemma map_complement l k : List.length l = rows -> k < n -> bit (nth k (map complement l) 0%N) = negb (bit (nth k l 0%N)).
  Proof.
    intros E K. rewrite (nth_indep _ 0%N (complement 0)) by (rewrite map_length; lia). rewrite map_nth. apply not_bits.
  Qed.

  Theorem value_right f : proper f = true -> right f.
  Proof.
    induction f as [b|i|f IH|f IHf g IHg|f IHf g IHg|f IHf lo hi g IHg|lo hi f IH|lo hi f IH]; cbn [proper]; cbv zeta;
      intros P; try (apply andb_prop in P as [P P2]); try (apply andb_prop in P as [P P3]); intros v k K;
      pose proof (proj2 (Nat.ltb_lt k n) K) as KB; cbn [recorded value]; cbv zeta; rewrite KB.
    - assert (E : forall x, nth k (repeat x rows) 0%N = x).
      { intros x. rewrite (nth_indep _ 0%N x) by (rewrite repeat_length; lia). apply nth_repeat. }
      rewrite E. destruct b; [rewrite top_bits|rewrite N.bits_0]; tauto.
    - reflexivity.
    - rewrite map_complement by (apply length_value || exact K). specialize (IH P (opposite v) k K).
      rewrite <- IH. destruct (bit _); cbn; intuition discriminate.
    - rewrite nth_zip by (rewrite length_value; lia). rewrite and_bits, andb_true_iff.
      rewrite (IHf P v k K), (IHg P2 v k K). reflexivity.
    - rewrite nth_zip by (rewrite length_value; lia). rewrite or_bits, orb_true_iff.
      rewrite (IHf P v k K), (IHg P2 v k K). reflexivity.
    - specialize (IHf P3). specialize (IHg P2). set (p := padding v false).
      assert (LF := length_padded (value v f) p (length_value v f)).
      assert (LG := length_padded (value v g) p (length_value v g)).
      rewrite (nth_indep _ 0%N p) by (rewrite length_until; lia).
      rewrite (until_right h N.lor N.land or_bits and_bits) by lia. rewrite LF. unfold reach, all_within.
      set (Q := fun j => seen v false g j = true /\ forall i, k + lo <= i < j -> seen v false f i = true).
      transitivity (exists m, m < samples_in_window lo hi rows /\ Q (k + lo + m)).
      { split; intros [m [M [A B]]]; exists m; (split; [exact M|]); (split; [exact A|]).
        - intros i I. replace i with (k + lo + (i - (k + lo))) by lia. apply B. lia.
        - intros i I. apply B. lia. }
      rewrite (cut_some k lo hi Q P).
      2:{ intros i j I [A B]. split; [rewrite <- (seen_late v false g i j I); exact A|]. intros x X. apply B. lia. }
      split; intros [j [J [A B]]]; exists j; (split; [exact J|]).
      + rewrite some_seen in A by exact IHg. destruct A as [A1 A2]. split; [exact A1|]. split; [exact A2|].
        intros i I. apply (some_seen v f i IHf), B, I.
      + destruct B as [B C]. split; [apply some_seen; auto|]. intros i I. apply (some_seen v f i IHf). split; [|apply C, I].
        destruct v; cbn in *; trivial; lia.
    - specialize (IH P2). set (p := padding v false).
      assert (LF := length_padded (value v f) p (length_value v f)).
      rewrite (nth_indep _ 0%N p) by (rewrite length_extremum; lia).
      rewrite (extremum_right h N.lor or_bits), LF. unfold some_within.
      set (Q := fun j => seen v false f j = true).
      transitivity (exists m, m < samples_in_window lo hi rows /\ Q (k + lo + m)); [reflexivity|].
      rewrite (cut_some k lo hi Q P).
      2:{ intros i j I A. unfold Q in *. rewrite <- (seen_late v false f i j I). exact A. }
      split; intros [j [J A]]; exists j; (split; [exact J|]); apply (some_seen v f j IH), A.
    - specialize (IH P2). set (p := padding v true).
      assert (LF := length_padded (value v f) p (length_value v f)).
      rewrite (nth_indep _ 0%N p) by (rewrite length_extremum; lia).
      rewrite (always_right h N.land and_bits), LF.
      set (g := fun j => seen v true f j).
      transitivity (forall m, m < samples_in_window lo hi rows -> g (k + lo + m) = true); [reflexivity|].
      rewrite (cut_all k lo hi g P (seen_late v true f)).
      split; intros H j J; apply (all_seen v f j IH), H, J.
  Qed.

  Theorem answer_right f k : proper f = true -> k < n -> right_answer truth_of n k f (answer f k trace).
  Proof.
    intros P K. pose proof (value_right f P Strong k K) as S. pose proof (value_right f P Weak k K) as W.
    unfold answer, right_answer. destruct (bit (nth k (value Strong f) 0%N)); [apply S; reflexivity|].
    destruct (bit (nth k (value Weak f) 0%N)).
    - split; [rewrite <- S; discriminate|apply W; reflexivity].
    - rewrite <- W. discriminate.
  Qed.
End Words.

(* --- every continuation -------------------------------------------------------------------------------------- *)

(* Strong implies the grid view of every continuation of the recording, and that implies Weak. *)
Lemma continued truth whole n : (forall i k, k < n -> truth i k <-> whole i k) -> forall f k,
  (recorded truth n Strong k f -> on_grid whole k f) /\ (on_grid whole k f -> recorded truth n Weak k f).
Proof.
  intros E f. induction f as [b|i|f IH|f IHf g IHg|f IHf g IHg|f IHf lo hi g IHg|lo hi f IH|lo hi f IH]; intros k;
    cbn [recorded on_grid]; destruct (Nat.ltb_spec k n) as [K|K]; cbn [after_the_end opposite]; try tauto.
  - rewrite (E i k K). tauto.
  - specialize (IH k). tauto.
  - specialize (IHf k). specialize (IHg k). tauto.
  - specialize (IHf k). specialize (IHg k). tauto.
  - split.
    + intros [j [A [_ [G F]]]]. exists j. split; [exact A|]. split; [apply IHg, G|]. intros i I. apply IHf, F, I.
    + intros [j [A [G F]]]. exists j. split; [exact A|]. split; [exact I|]. split; [apply IHg, G|]. intros i Hi. apply IHf, F, Hi.
  - split.
    + intros [j [A [_ F]]]. exists j. split; [exact A|apply IH, F].
    + intros [j [A F]]. exists j. split; [exact A|]. split; [exact I|apply IH, F].
  - split.
    + intros F j A. apply IH, F; [exact A|exact I].
    + intros F j A _. apply IH, F, A.
Qed.

Open Scope R_scope.

Section Kept.
  Variable W : world.
  Variable dt : Q.
  Hypothesis forward : 0 < Q2R dt.
  Variable states : nat -> formula.
  Variable named : string -> element W.
  Notation K := (kept W dt).
  Notation time := (time_of dt).

  (* t is in step k *)
  Definition in_step (k : nat) (t : R) : Prop := INR k <= t / Q2R dt < INR k + 1.
  Lemma last_sample_in k t : in_step k t -> last_sample dt t = time k.
  Proof.
    intros [A B]. unfold last_sample, time_of. rewrite INR_IZR_INZ in *. f_equal. f_equal.
    unfold Int_part. rewrite <- (tech_up (t / Q2R dt) (Z.of_nat k + 1)) by (rewrite plus_IZR; lra). lia.
  Qed.
  Lemma some_step t : 0 <= t / Q2R dt -> exists k, in_step k t.
  Proof.
    intros H. exists (Z.to_nat (Int_part (t / Q2R dt))). unfold in_step. destruct (base_Int_part (t / Q2R dt)) as [A B].
    set (z := Int_part (t / Q2R dt)) in *.
    assert (0 <= z)%Z. { assert (-1 < z)%Z; [apply lt_IZR; simpl; lra|lia]. }
    rewrite INR_IZR_INZ, Z2Nat.id by assumption. lra.
  Qed.
  Lemma time_at x : exists t, t / Q2R dt = x.
  Proof. exists (x * Q2R dt). field. lra. Qed.
  Lemma less_steps j k : INR j < INR k + 1 -> (j <= k)%nat.
  Proof. intros H. rewrite <- S_INR in H. apply INR_lt in H. lia. Qed.
  Lemma in_steps t n u : t + time n <= u <-> t / Q2R dt + INR n <= u / Q2R dt.
  Proof.
    unfold time_of. split; intros H.
    - apply (Rmult_le_reg_r (Q2R dt)); [exact forward|]. field_simplify; lra.
    - apply (Rmult_le_compat_r (Q2R dt)) in H; [|lra]. field_simplify in H; lra.
  Qed.
  Lemma in_steps' t n u : u <= t + time n <-> u / Q2R dt <= t / Q2R dt + INR n.
  Proof.
    unfold time_of. split; intros H.
    - apply (Rmult_le_reg_r (Q2R dt)); [exact forward|]. field_simplify; lra.
    - apply (Rmult_le_compat_r (Q2R dt)) in H; [|lra]. field_simplify in H; lra.
  Qed.
  Lemma before t u : t < u -> t / Q2R dt < u / Q2R dt.
  Proof. intros H. apply Rmult_lt_compat_r; [apply Rinv_0_lt_compat, forward|exact H]. Qed.
  Lemma before' t u : t / Q2R dt < u / Q2R dt -> t < u.
  Proof. apply Rmult_lt_reg_r, Rinv_0_lt_compat, forward. Qed.

  Lemma number_kept t x : number K t x = number W (last_sample dt t) x.
  Proof. induction x; cbn [number]; try reflexivity; congruence. Qed.
  Lemma side_kept t s : extended_number K t s = extended_number W (last_sample dt t) s.
  Proof. destruct s; cbn [extended_number]; rewrite number_kept; reflexivity. Qed.
  Lemma instant_kept f : instant f -> forall bound t,
    holds K named bound t f <-> holds W named bound (last_sample dt t) f.
  Proof.
    induction f as [b|l o r|a l|m d f IH|m d f IH|f IH|f IHf g IHg|f IHf g IHg| | |]; cbn [instant];
      intros P bound t; try contradiction; cbn [holds].
    - reflexivity.
    - rewrite !side_kept. reflexivity.
    - reflexivity.
    - split; intros [e [M H]]; exists e; (split; [exact M|]); apply (IH P (bind W bound m e) t), H.
    - split; intros H e M; apply (IH P (bind W bound m e) t), H, M.
    - rewrite (IH P bound t). reflexivity.
    - destruct P as [P Q]. rewrite (IHf P bound t), (IHg Q bound t). reflexivity.
    - destruct P as [P Q]. rewrite (IHf P bound t), (IHg Q bound t). reflexivity.
  Qed.

  (* u is in t + [lo, hi]: its step is among those of the window, and each of these has such a u *)
  Lemma within_steps lo hi a b t u : lasts W dt lo a -> last_at_most W dt hi b -> within K t lo hi u <->
    t / Q2R dt + INR a <= u / Q2R dt /\ match b with None => True | Some b => u / Q2R dt <= t / Q2R dt + INR b end.
  Proof.
    intros A B. unfold within. rewrite number_kept, (A _), in_steps.
    destruct hi as [hi|], b as [b|]; cbn in B; try contradiction; [|tauto]. rewrite number_kept, (B _), in_steps'. tauto.
  Qed.
  Lemma step_among lo hi a b k t u : lasts W dt lo a -> last_at_most W dt hi b -> in_step k t -> within K t lo hi u ->
    exists j, in_step j u /\ among k a b j.
  Proof.
    intros A B [I1 I2] L. apply (within_steps _ _ _ _ _ _ A B) in L as [L1 L2].
    pose proof (pos_INR k). pose proof (pos_INR a).
    destruct (some_step u) as [j [J1 J2]]; [lra|]. exists j. split; [split; assumption|]. split.
    - apply less_steps. rewrite plus_INR. lra.
    - destruct b as [b|]; [|trivial]. apply less_steps. rewrite plus_INR. lra.
  Qed.
  Lemma among_step lo hi a b k t j : lasts W dt lo a -> last_at_most W dt hi b -> in_step k t -> among k a b j ->
    exists u, in_step j u /\ within K t lo hi u.
  Proof.
    intros LA LB [I1 I2] [A B]. destruct (time_at (t / Q2R dt + (INR j - INR k))) as [u U]. exists u.
    apply le_INR in A. rewrite plus_INR in A. split; [split; lra|].
    apply (within_steps _ _ _ _ _ _ LA LB). split; [lra|].
    destruct b as [b|]; [|trivial]. apply le_INR in B. rewrite plus_INR in B. lra.
  Qed.
  (* A time in step j of the window, before which the window has steps before j only *)
  Lemma first_in_step lo hi a b k t j : lasts W dt lo a -> last_at_most W dt hi b -> in_step k t -> among k a b j ->
    exists u, in_step j u /\ within K t lo hi u /\
      forall w, t + number K t lo <= w < u -> exists i, in_step i w /\ (k + a <= i < j)%nat.
  Proof.
    intros LA LB [I1 I2] A. pose proof (pos_INR k). pose proof (pos_INR a).
    assert (LO : number K t lo = time a) by (rewrite number_kept; apply LA).
    destruct (Nat.eq_dec j (k + a)) as [->|N].
    - destruct (time_at (t / Q2R dt + INR a)) as [u U]. exists u. split; [split; rewrite plus_INR; lra|]. split.
      + apply (within_steps _ _ _ _ _ _ LA LB). split; [lra|]. destruct A as [_ A]. destruct b as [b|]; [|trivial].
        apply le_INR in A. rewrite !plus_INR in A. lra.
      + intros w [W1 W2]. exfalso. rewrite LO in W1. apply in_steps in W1. apply before in W2. lra.
    - destruct A as [A1 A2]. assert (A3 : (k + a + 1 <= j)%nat) by lia. apply le_INR in A3.
      rewrite !plus_INR in A3. simpl (INR 1) in A3. destruct (time_at (INR j)) as [u U]. exists u.
      split; [split; lra|]. split.
      + apply (within_steps _ _ _ _ _ _ LA LB). split; [lra|]. destruct b as [b|]; [|trivial].
        apply le_INR in A2. rewrite plus_INR in A2. lra.
      + intros w [W1 W2]. rewrite LO in W1. apply in_steps in W1. apply before in W2.
        destruct (some_step w) as [i [J1 J2]]; [lra|]. exists i. split; [split; assumption|]. split.
        * apply less_steps. rewrite plus_INR. lra.
        * apply INR_lt. lra.
  Qed.

  Notation says t f := (holds K named (unbound K) t f).
  Notation grid := (on_grid (at_samples W dt states named)).

  (* The world of step traces says what the grid view says of its samples. *)
  Theorem kept_right s : forall f, written W dt states f s -> forall k t, in_step k t -> says t f <-> grid k s.
  Proof.
    induction s as [c|i|s IH|s IHs r IHr|s IHs r IHr|s IHs a b r IHr|a b s IH|a b s IH]; intros f P k t T; cbn [written] in P.
    - subst f. reflexivity.
    - destruct P as [-> P]. cbn [on_grid]. unfold at_samples. rewrite instant_kept by exact P.
      rewrite (last_sample_in k t T). reflexivity.
    - destruct f; try contradiction. cbn [holds on_grid]. rewrite (IH f P k t T). reflexivity.
    - destruct f as [| | | | | |f g| | | |]; try contradiction. destruct P as [P Q]. cbn [holds on_grid].
      rewrite (IHs f P k t T), (IHr g Q k t T). reflexivity.
    - destruct f as [| | | | | | |f g| | |]; try contradiction. destruct P as [P Q]. cbn [holds on_grid].
      rewrite (IHs f P k t T), (IHr g Q k t T). reflexivity.
    - destruct f as [| | | | | | | |f lo hi g| |]; try contradiction. destruct P as [P [LA [LB Q]]]. cbn [holds on_grid]. split.
      + intros [u [U [G F]]]. destruct (step_among lo hi a b k t u LA LB T U) as [j [J A]].
        exists j. split; [exact A|]. split; [apply (IHr g Q j u J), G|]. intros i [I1 I2].
        destruct (time_at (t / Q2R dt + (INR i - INR k))) as [w E]. destruct T as [T1 T2].
        assert (IW : in_step i w) by (split; lra). apply (IHs f P i w IW), F. rewrite number_kept, (LA _). split.
        * apply in_steps. apply le_INR in I1. rewrite plus_INR in I1. lra.
        * apply before'. destruct J as [J1 _]. assert (I3 : (i + 1 <= j)%nat) by lia.
          apply le_INR in I3. rewrite plus_INR in I3. simpl (INR 1) in I3. lra.
      + intros [j [A [G F]]]. destruct (first_in_step lo hi a b k t j LA LB T A) as [u [J [U B]]].
        exists u. split; [exact U|]. split; [apply (IHr g Q j u J), G|]. intros w Hw.
        destruct (B w Hw) as [i [I Hi]]. apply (IHs f P i w I), F, Hi.
    - destruct f as [| | | | | | | | |lo hi f|]; try contradiction. destruct P as [LA [LB P]]. cbn [holds on_grid]. split.
      + intros [u [U F]]. destruct (step_among lo hi a b k t u LA LB T U) as [j [J A]].
        exists j. split; [exact A|]. apply (IH f P j u J), F.
      + intros [j [A F]]. destruct (among_step lo hi a b k t j LA LB T A) as [u [J U]].
        exists u. split; [exact U|]. apply (IH f P j u J), F.
    - destruct f as [| | | | | | | | | |lo hi f]; try contradiction. destruct P as [LA [LB P]]. cbn [holds on_grid]. split.
      + intros H j A. destruct (among_step lo hi a b k t j LA LB T A) as [u [J U]]. apply (IH f P j u J), H, U.
      + intros H u U. destruct (step_among lo hi a b k t u LA LB T U) as [j [J A]]. apply (IH f P j u J), H, A.
  Qed.
End Kept.

(* A world continues a trace where it has, at the samples of the trace, the truth values that are recorded. *)
Definition continues (W : world) (dt : Q) (states : nat -> formula) (named : string -> element W)
  (columns : nat -> list N) (trace n : nat) : Prop :=
  forall i k, (k < n)%nat -> truth_of columns trace i k <-> at_samples W dt states named i k.

(* If the monitor says Yes of a trace at sample k, the formula is true then of every continuation that keeps each
   sample until the next; if it says No, of none. *)
Theorem decided bits rows lengths columns trace n dt states f s k :
  nth_error lengths trace = Some n -> (k < n <= rows)%nat -> (N.of_nat trace < bits)%N ->
  (forall i, List.length (columns i) = rows) -> proper s = true -> 0 < Q2R dt ->
  forall (W : world) (named : string -> element W), written W dt states f s ->
  continues W dt states named columns trace n ->
  match answer bits rows lengths columns s k trace with
  | Yes => holds (kept W dt) named (unbound (kept W dt)) (time_of dt k) f
  | No => ~ holds (kept W dt) named (unbound (kept W dt)) (time_of dt k) f
  | Undecided => True
  end.
Proof.
  intros H [N R] B L P D W named F C.
  pose proof (answer_right bits rows lengths columns trace n H R B L s k P N) as A.
  destruct (continued _ _ n C s k) as [S X].
  assert (Z : in_step dt k (time_of dt k)).
  { unfold in_step, time_of. replace (INR k * Q2R dt / Q2R dt) with (INR k) by (field; lra). lra. }
  pose proof (kept_right W dt D states named s f F k (time_of dt k) Z) as E.
  destruct (answer _ _ _ _ _ _ _); cbn [right_answer] in A; trivial; rewrite E; auto.
Qed.
