(* Trees that show that a program has no solution.  NOT TRUSTED: proved.

   A tree distinguishes the parts of disjunctions and halves of intervals.  At each leaf, multiples of known
   facts add up to a sum that is negative everywhere between the bounds.  `refutes` checks a tree, and `no_solution`
   says that it is right. *)
From Coq Require Import Reals ZArith PArith List Bool Lia Lra FMapPositive.
From Roadproof Require Import Programs.
Import ListNotations.
Open Scope R_scope.
(* A name for a module would extract all of it. *)
Local Notation Table := PositiveMap.t. Local Notation empty := PositiveMap.empty.
Local Notation find := PositiveMap.find. Local Notation mem := PositiveMap.mem.
Local Notation add := PositiveMap.add. Local Notation gso := PositiveMap.gso.
Local Notation gss := PositiveMap.gss. Local Notation gempty := PositiveMap.gempty.

(* --- tables ------------------------------------------------------------------------------------------ *)
Fixpoint table {A} (l : list (positive * A)) : Table A :=
  match l with [] => empty A | (k, a) :: l => add k a (table l) end.
Lemma find_table {A} (l : list (positive * A)) k a : find k (table l) = Some a -> In (k, a) l.
Proof.
  induction l as [|[j b] l IH]; simpl; [rewrite gempty; discriminate|].
  destruct (Pos.eq_dec k j) as [->|N]; [rewrite gss|rewrite gso by exact N]; intros H; auto.
  injection H as ->. auto.
Qed.
(* Every number stands for one thing, so that a node is what the table says. *)
Fixpoint distinct {A} (l : list (positive * A)) : bool :=
  match l with [] => true | (k, _) :: l => negb (mem k (table l)) && distinct l end.
Lemma in_table {A} (l : list (positive * A)) k a :
  distinct l = true -> In (k, a) l -> find k (table l) = Some a.
Proof.
  induction l as [|[j b] l IH]; simpl; [tauto|]. intros H. apply andb_prop in H as [N H].
  intros [E|I]; [injection E as -> ->; apply gss|].
  specialize (IH H I). destruct (Pos.eq_dec k j) as [->|D]; [|rewrite gso by exact D; exact IH].
  apply negb_true_iff in N. rewrite PositiveMap.mem_find, IH in N. discriminate.
Qed.

(* --- sums -------------------------------------------------------------------------------------------- *)
Fixpoint merge (u : list (positive * Z)) : list (positive * Z) -> list (positive * Z) :=
  fix into v := match u, v with
    | [], _ => v
    | _, [] => u
    | (i, a) :: u', (j, b) :: v' =>
        match Pos.compare i j with
        | Eq => (i, (a + b)%Z) :: merge u' v'
        | Lt => (i, a) :: merge u' v
        | Gt => (j, b) :: into v'
        end
    end.
Lemma value_merge x u : forall v, value x (merge u v) = value x u + value x v.
Proof.
  induction u as [|[i a] u IH]; intros v; [destruct v; simpl; lra|].
  induction v as [|[j b] v IHv]; [simpl; lra|].
  change (merge ((i, a) :: u) ((j, b) :: v)) with
    (match Pos.compare i j with
     | Eq => (i, (a + b)%Z) :: merge u v
     | Lt => (i, a) :: merge u ((j, b) :: v)
     | Gt => (j, b) :: merge ((i, a) :: u) v
     end).
  destruct (Pos.compare_spec i j) as [->| |]; cbn [value].
  - rewrite IH, plus_IZR. lra.
  - rewrite IH. cbn [value]. lra.
  - rewrite IHv. cbn [value]. lra.
Qed.
Definition times (w : Z) (u : list (positive * Z)) := map (fun e => (fst e, (w * snd e)%Z)) u.
Lemma value_times x w u : value x (times w u) = IZR w * value x u.
Proof. induction u as [|[k c] u IH]; simpl; [lra|]. rewrite IH, mult_IZR. lra. Qed.

Inductive fact :=
  | Equal (n : positive) | Above (n : positive) | Known (n : positive)
  | Corner (k : positive) (first second : bool)                  (* ends of the factors, true for the high ones *)
  | Tangent (k : positive) (at_ : Z).
Inductive tree :=
  | Sum (weights : list (fact * Z))
  | Cases (n : positive) (each : trees)
  | Cut (k : positive) (at_ : Z) (low high : tree)
with trees := Done | More (t : tree) (each : trees).
Definition a_multiple (f : fact) (w : Z) := (f, w).             (* how they are printed *)
Scheme tree_both := Induction for tree Sort Prop with trees_both := Induction for trees Sort Prop.
Combined Scheme tree_trees from tree_both, trees_both.

(* --- the checker ------------------------------------------------------------------------------------- *)
Record tables := {
  size : Z; product_of : Table (positive * positive); equals : Table linear; aboves : Table linear;
  node_of : Table node }.
Record state := { box : Table (Z * Z); known : Table unit }.

Section Checker.
Variable T : tables.

Definition pick (b : bool) (ends : Z * Z) : Z := if b then snd ends else fst ends.
Definition corner (k i j : positive) (a b : Z) : linear :=
  let D := size T in
  (merge (merge [(i, (- D * b)%Z)] [(j, (- D * a)%Z)]) [(k, (D * D)%Z)], (a * b)%Z).
(* Is it an equation, is it strict, and what is at least 0. *)
Definition says (s : state) (f : fact) : option (bool * bool * linear) :=
  match f with
  | Equal n => match find n (equals T) with Some l => Some (true, false, l) | None => None end
  | Above n => match find n (aboves T) with Some l => Some (false, false, l) | None => None end
  | Known n =>
      match find n (known s), find n (node_of T) with
      | Some _, Some (Holds strict l) => Some (false, strict, l)
      | _, _ => None
      end
  | Corner k first second =>
      match find k (product_of T) with
      | Some (i, j) =>
          match find i (box s), find j (box s) with
          | Some one, Some other =>
              let l := corner k i j (pick first one) (pick second other) in
              Some (false, false, if Bool.eqb first second then l else (times (-1) (fst l), (- snd l)%Z))
          | _, _ => None
          end
      | None => None
      end
  | Tangent k a =>
      match find k (product_of T) with
      | Some (i, j) => if Pos.eqb i j then Some (false, false, corner k i j a a) else None
      | None => None
      end
  end.
Fixpoint total (s : state) (weights : list (fact * Z)) : option (bool * linear) :=
  match weights with
  | [] => Some (false, ([], 0%Z))
  | (f, w) :: weights =>
      match says s f, total s weights with
      | Some (equation, strict, l), Some (strict', l') =>
          if equation || (0 <=? w)%Z
          then Some ((strict && (0 <? w)%Z) || strict', (merge (times w (fst l)) (fst l'), (w * snd l + snd l')%Z))
          else None
      | _, _ => None
      end
  end.
Definition greatest (s : state) (k : positive) (c : Z) : option Z :=
  match find k (product_of T) with
  | Some (i, j) =>
      match find i (box s), find j (box s) with
      | Some (a, b), Some (a', b') =>
          Some (Z.max (Z.max (c * (a * a')) (c * (a * b'))) (Z.max (c * (b * a')) (c * (b * b'))))%Z
      | _, _ => None
      end
  | None =>
      match find k (box s) with
      | Some (a, b) => Some (size T * Z.max (c * a) (c * b))%Z
      | None => None
      end
  end.
Fixpoint most (s : state) (terms : list (positive * Z)) : option Z :=
  match terms with
  | [] => Some 0%Z
  | (k, c) :: terms =>
      match greatest s k c, most s terms with Some a, Some b => Some (a + b)%Z | _, _ => None end
  end.
Definition absurd_sum (s : state) (weights : list (fact * Z)) : bool :=
  match total s weights with
  | Some (strict, l) =>
      match most s (fst l) with
      | Some a => let q := (snd l * (size T * size T) + a)%Z in (q <? 0)%Z || (strict && (q <=? 0)%Z)
      | None => false
      end
  | None => false
  end.
Fixpoint learn (fuel : nat) (k : Table unit) (n : positive) : Table unit :=
  let k := add n tt k in
  match fuel, find n (node_of T) with
  | S fuel, Some (Every parts) => fold_left (learn fuel) parts k
  | _, _ => k
  end.
Definition DEPTH := 6%nat.
Definition also (s : state) (n : positive) := {| box := box s; known := learn DEPTH (known s) n |}.
Definition within (s : state) (k : positive) (ends : Z * Z) := {| box := add k ends (box s); known := known s |}.

Fixpoint refutes (s : state) (t : tree) : bool :=
  match t with
  | Sum weights => absurd_sum s weights
  | Cases n each =>
      match find n (known s), find n (node_of T) with
      | Some _, Some (Either parts) => refutes_all s parts each
      | _, _ => false
      end
  | Cut k a low high =>
      match find k (box s) with
      | Some (l, h) => refutes (within s k (l, a)) low && refutes (within s k (a, h)) high
      | None => false
      end
  end
with refutes_all (s : state) (parts : list positive) (each : trees) : bool :=
  match parts, each with
  | [], Done => true
  | p :: parts, More t each => refutes (also s p) t && refutes_all s parts each
  | _, _ => false
  end.

(* --- what makes it right ------------------------------------------------------------------------------ *)
Variable x : positive -> R.
Variable given : list (positive * node).
Hypothesis positive_size : (0 < size T)%Z.
Hypothesis products_hold : forall k i j, find k (product_of T) = Some (i, j) -> x k = x i * x j.
Hypothesis equals_hold : forall n l, find n (equals T) = Some l -> worth x l = 0.
Hypothesis aboves_hold : forall n l, find n (aboves T) = Some l -> 0 <= worth x l.
Hypothesis nodes_given : forall n e, In (n, e) given -> find n (node_of T) = Some e.

Definition right (s : state) : Prop :=
  (forall k a b, find k (box s) = Some (a, b) -> IZR a <= IZR (size T) * x k <= IZR b)
  /\ (forall n, find n (known s) <> None -> true_at x given n).

Lemma true_leaf n strict l : true_at x given n -> find n (node_of T) = Some (Holds strict l) ->
  if strict then 0 < worth x l else 0 <= worth x l.
Proof.
  intros A F. destruct A as [n s l' I W|n parts I V|n parts p I O V]; apply nodes_given in I; rewrite F in I;
    try discriminate. injection I as -> ->. exact W.
Qed.
Lemma true_every n parts : true_at x given n -> find n (node_of T) = Some (Every parts) ->
  forall p, In p parts -> true_at x given p.
Proof.
  intros A F. destruct A as [n s l I W|n parts' I V|n parts' p I O V]; apply nodes_given in I; rewrite F in I;
    try discriminate. injection I as ->. exact V.
Qed.
Lemma true_either n parts : true_at x given n -> find n (node_of T) = Some (Either parts) ->
  exists p, In p parts /\ true_at x given p.
Proof.
  intros A F. destruct A as [n s l I W|n parts' I V|n parts' p I O V]; apply nodes_given in I; rewrite F in I;
    try discriminate. injection I as ->. eauto.
Qed.
Lemma worth_corner k i j a b : x k = x i * x j ->
  worth x (corner k i j a b) = (IZR (size T) * x i - IZR a) * (IZR (size T) * x j - IZR b).
Proof.
  intros E. unfold worth, corner. cbn [fst snd]. rewrite !value_merge. cbn [value].
  rewrite ?mult_IZR, ?opp_IZR, E. ring.
Qed.
Opaque corner.
Definition said_holds (r : bool * bool * linear) : Prop :=
  let '(equation, strict, l) := r in
  if (equation : bool) then worth x l = 0 else if (strict : bool) then 0 < worth x l else 0 <= worth x l.
Lemma says_sound s f r : right s -> says s f = Some r -> said_holds r /\ (fst (fst r) = true -> snd (fst r) = false).
Proof.
  intros [B K] H. destruct f as [n|n|n|k first second|k a]; cbn [says] in H.
  - destruct (find n (equals T)) as [l|] eqn:E; [|discriminate]. injection H as <-. simpl. eauto.
  - destruct (find n (aboves T)) as [l|] eqn:E; [|discriminate]. injection H as <-. simpl. eauto.
  - destruct (find n (known s)) as [u|] eqn:E; [|discriminate].
    destruct (find n (node_of T)) as [[strict l|?|?]|] eqn:F; try discriminate.
    injection H as <-. split; [|discriminate]. simpl.
    apply (true_leaf n); [apply K; congruence|exact F].
  - destruct (find k (product_of T)) as [[i j]|] eqn:E; [|discriminate].
    destruct (find i (box s)) as [[a b]|] eqn:F; [|discriminate].
    destruct (find j (box s)) as [[a' b']|] eqn:G; [|discriminate].
    injection H as <-. split; [|discriminate]. unfold said_holds.
    apply products_hold in E. apply B in F as [F1 F2]. apply B in G as [G1 G2].
    pose proof (fun p q => worth_corner k i j p q E) as C.
    assert (W : forall l, worth x (times (-1) (fst l), (- snd l)%Z) = - worth x l).
    { intros l. unfold worth. cbn [fst snd]. rewrite value_times, opp_IZR. lra. }
    destruct first, second; cbn [Bool.eqb pick fst snd]; rewrite ?W, C.
    + pose proof (Rmult_le_pos (IZR b - IZR (size T) * x i) (IZR b' - IZR (size T) * x j)). lra.
    + pose proof (Rmult_le_pos (IZR b - IZR (size T) * x i) (IZR (size T) * x j - IZR a')). lra.
    + pose proof (Rmult_le_pos (IZR (size T) * x i - IZR a) (IZR b' - IZR (size T) * x j)). lra.
    + apply Rmult_le_pos; lra.
  - destruct (find k (product_of T)) as [[i j]|] eqn:E; [|discriminate].
    destruct (Pos.eqb_spec i j) as [->|]; [|discriminate].
    injection H as <-. split; [|discriminate]. unfold said_holds. apply products_hold in E.
    rewrite (worth_corner _ _ _ _ _ E). apply Rle_0_sqr.
Qed.
Lemma total_sound s weights : right s -> forall strict l, total s weights = Some (strict, l) ->
  if (strict : bool) then 0 < worth x l else 0 <= worth x l.
Proof.
  intros S. induction weights as [|[f w] weights IH]; intros strict l H; simpl in H.
  { injection H as <- <-. unfold worth. simpl. lra. }
  destruct (says s f) as [[[equation strict1] l1]|] eqn:E; [|discriminate].
  destruct (total s weights) as [[strict2 l2]|] eqn:F; [|discriminate].
  specialize (IH _ _ eq_refl). apply (says_sound _ _ _ S) in E as [E N]. simpl in E, N.
  destruct (equation || (0 <=? w)%Z) eqn:W; [|discriminate]. injection H as <- <-.
  assert (V : worth x (merge (times w (fst l1)) (fst l2), (w * snd l1 + snd l2)%Z)
              = IZR w * worth x l1 + worth x l2).
  { unfold worth. cbn [fst snd]. rewrite value_merge, value_times, plus_IZR, mult_IZR. ring. }
  rewrite V. destruct equation; simpl in W.
  - rewrite (N eq_refl), E, Rmult_0_r, Rplus_0_l. simpl. exact IH.
  - apply Z.leb_le in W. pose proof (IZR_le _ _ W) as P.
    destruct strict1; simpl.
    + destruct (Z.ltb_spec 0 w) as [L|L]; simpl.
      * apply IZR_lt in L. pose proof (Rmult_lt_0_compat _ _ L E). destruct strict2; lra.
      * assert (w = 0%Z) by lia. subst w. rewrite Rmult_0_l, Rplus_0_l. exact IH.
    + pose proof (Rmult_le_pos _ _ P E). destruct strict2; lra.
Qed.
(* On an interval a multiple is at most that at one of the ends. *)
Lemma at_ends c a b y : a <= y <= b -> c * y <= Rmax (c * a) (c * b).
Proof.
  intros [A B]. destruct (Rle_dec 0 c) as [P|P].
  - eapply Rle_trans; [apply Rmult_le_compat_l; [exact P|exact B]|apply Rmax_r].
  - eapply Rle_trans; [apply Rmult_le_compat_neg_l; [lra|exact A]|apply Rmax_l].
Qed.
Lemma max_IZR a b : Rmax (IZR a) (IZR b) = IZR (Z.max a b).
Proof.
  destruct (Z.max_spec a b) as [[L ->]|[L ->]].
  - apply Rmax_right, IZR_le; lia.
  - apply Rmax_left, IZR_le; lia.
Qed.
Lemma greatest_sound s k c q : right s -> greatest s k c = Some q ->
  IZR (size T) * IZR (size T) * (IZR c * x k) <= IZR q.
Proof.
  intros [B K] H. unfold greatest in H. assert (P : 0 < IZR (size T)) by (apply IZR_lt; exact positive_size).
  destruct (find k (product_of T)) as [[i j]|] eqn:E.
  - destruct (find i (box s)) as [[a b]|] eqn:F; [|discriminate].
    destruct (find j (box s)) as [[a' b']|] eqn:G; [|discriminate].
    injection H as <-. rewrite (products_hold _ _ _ E). apply B in F. apply B in G.
    rewrite <- !max_IZR, !mult_IZR.
    replace (IZR (size T) * IZR (size T) * (IZR c * (x i * x j)))
      with (IZR c * (IZR (size T) * x j) * (IZR (size T) * x i)) by ring.
    eapply Rle_trans; [apply (at_ends _ _ _ _ F)|].
    apply Rmax_lub.
    + eapply Rle_trans; [|apply Rmax_l].
      replace (IZR c * (IZR (size T) * x j) * IZR a) with (IZR c * IZR a * (IZR (size T) * x j)) by ring.
      eapply Rle_trans; [apply (at_ends _ _ _ _ G)|]. rewrite !Rmult_assoc. apply Rle_refl.
    + eapply Rle_trans; [|apply Rmax_r].
      replace (IZR c * (IZR (size T) * x j) * IZR b) with (IZR c * IZR b * (IZR (size T) * x j)) by ring.
      eapply Rle_trans; [apply (at_ends _ _ _ _ G)|]. rewrite !Rmult_assoc. apply Rle_refl.
  - destruct (find k (box s)) as [[a b]|] eqn:F; [|discriminate].
    injection H as <-. apply B in F. rewrite mult_IZR, <- max_IZR, !mult_IZR.
    replace (IZR (size T) * IZR (size T) * (IZR c * x k))
      with (IZR (size T) * (IZR c * (IZR (size T) * x k))) by ring.
    apply Rmult_le_compat_l; [lra|]. apply at_ends. exact F.
Qed.
Lemma most_sound s terms : right s -> forall q, most s terms = Some q ->
  IZR (size T) * IZR (size T) * value x terms <= IZR q.
Proof.
  intros S. induction terms as [|[k c] terms IH]; intros q H; simpl in H.
  { injection H as <-. simpl. lra. }
  destruct (greatest s k c) as [a|] eqn:E; [|discriminate].
  destruct (most s terms) as [b|]; [|discriminate]. injection H as <-.
  apply (greatest_sound _ _ _ _ S) in E. specialize (IH _ eq_refl). simpl. rewrite plus_IZR. lra.
Qed.
Lemma absurd_sum_sound s weights : right s -> absurd_sum s weights = true -> False.
Proof.
  intros S H. unfold absurd_sum in H.
  destruct (total s weights) as [[strict l]|] eqn:E; [|discriminate].
  apply (total_sound _ _ S) in E. destruct (most s (fst l)) as [a|] eqn:F; [|discriminate].
  apply (most_sound _ _ S) in F.
  assert (P : 0 < IZR (size T) * IZR (size T)) by
    (apply Rmult_lt_0_compat; apply IZR_lt; exact positive_size).
  assert (Q : IZR (size T) * IZR (size T) * worth x l <= IZR (snd l * (size T * size T) + a)).
  { unfold worth. rewrite plus_IZR, !mult_IZR. lra. }
  apply orb_prop in H as [H|H].
  - apply Z.ltb_lt, IZR_lt in H.
    assert (0 <= worth x l) by (destruct strict; lra).
    pose proof (Rmult_le_pos _ _ (Rlt_le _ _ P) H0). lra.
  - apply andb_prop in H as [-> H]. apply Z.leb_le, IZR_le in H.
    pose proof (Rmult_lt_0_compat _ _ P E). lra.
Qed.
Lemma learn_sound fuel : forall k n, (forall m, find m k <> None -> true_at x given m) -> true_at x given n ->
  forall m, find m (learn fuel k n) <> None -> true_at x given m.
Proof.
  induction fuel as [|fuel IH]; intros k n K A.
  - intros m. simpl. destruct (Pos.eq_dec m n) as [->|D]; [auto|]. rewrite gso by exact D. apply K.
  - assert (L : forall m, find m (add n tt k) <> None -> true_at x given m).
    { intros m. destruct (Pos.eq_dec m n) as [->|D]; [auto|]. rewrite gso by exact D. apply K. }
    simpl. destruct (find n (node_of T)) as [[? ?|parts|?]|] eqn:F; try exact L.
    pose proof (true_every _ _ A F) as P.
    clear F. revert L. generalize (add n tt k). clear k K.
    induction parts as [|p parts IHp]; intros k L; simpl; [exact L|].
    apply IHp; [intros q Q; apply P; right; exact Q|]. apply IH; [exact L|]. apply P. left. reflexivity.
Qed.
Lemma also_right s n : right s -> true_at x given n -> right (also s n).
Proof. intros [B K] A. split; [exact B|]. exact (learn_sound DEPTH (known s) n K A). Qed.
Lemma within_right s k a b : right s -> IZR a <= IZR (size T) * x k <= IZR b -> right (within s k (a, b)).
Proof.
  intros [B K] A. split; [|exact K]. intros j p q. simpl.
  destruct (Pos.eq_dec j k) as [->|D]; [rewrite gss|rewrite gso by exact D]; [|apply B].
  intros H. injection H as <- <-. exact A.
Qed.
Lemma refutes_sound :
  (forall t s, right s -> refutes s t = true -> False)
  /\ (forall each parts s, right s -> refutes_all s parts each = true ->
        forall p, In p parts -> true_at x given p -> False).
Proof.
  apply tree_trees.
  - intros weights s S H. eapply absurd_sum_sound; [exact S|exact H].
  - intros n each IH s S H. simpl in H.
    destruct (find n (known s)) as [u|] eqn:E; [|discriminate].
    destruct (find n (node_of T)) as [[? ?|?|parts]|] eqn:F; try discriminate.
    assert (A : true_at x given n) by (apply (proj2 S); congruence).
    destruct (true_either _ _ A F) as (p & O & V). eapply IH; eassumption.
  - intros k a low IHl high IHh s S H. simpl in H.
    destruct (find k (box s)) as [[l h]|] eqn:E; [|discriminate].
    apply andb_prop in H as [Hl Hh]. pose proof (proj1 S _ _ _ E) as [A B].
    destruct (Rle_dec (IZR (size T) * x k) (IZR a)) as [C|C].
    + eapply IHl; [|exact Hl]. apply within_right; [exact S|lra].
    + eapply IHh; [|exact Hh]. apply within_right; [exact S|lra].
  - intros parts s S H p I. destruct parts; [contradiction|discriminate].
  - intros t IHt each IHe parts s S H p I A. destruct parts as [|q parts]; [contradiction|].
    simpl in H. apply andb_prop in H as [Ht He]. destruct I as [->|I].
    + eapply IHt; [|exact Ht]. apply also_right; assumption.
    + eapply IHe; eassumption.
Qed.
End Checker.

Definition tables_of (p : program) : tables :=
  {| size := scale p; product_of := table (products p); equals := table (equal p); aboves := table (above p);
     node_of := table (nodes p) |}.
Definition begin (p : program) : state :=
  also (tables_of p) {| box := table (columns p); known := empty unit |} (condition p).
Definition checks (p : program) (t : tree) : bool :=
  (0 <? scale p)%Z && distinct (nodes p) && refutes (tables_of p) (begin p) t.

Theorem no_solution (p : program) (t : tree) : checks p t = true -> forall x, ~ solves x p.
Proof.
  intros H x (C & P & E & A & N). unfold checks in H.
  apply andb_prop in H as [H R]. apply andb_prop in H as [D U]. apply Z.ltb_lt in D.
  assert (given : forall n e, In (n, e) (nodes p) -> find n (node_of (tables_of p)) = Some e)
    by (intros n e; apply in_table; exact U).
  refine (proj1 (refutes_sound (tables_of p) x (nodes p) D _ _ _ given) t (begin p) _ R).
  - intros k i j F. apply (P k). apply find_table. exact F.
  - intros n l F. apply (E n). apply find_table. exact F.
  - intros n l F. apply (A n). apply find_table. exact F.
  - apply also_right; [exact given| |exact N]. split.
    + intros k a b F. apply (C k). apply find_table. exact F.
    + intros n F. simpl in F. rewrite gempty in F. congruence.
Qed.
