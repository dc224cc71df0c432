(* A checker of derivations about drives, and the proof that it is right.  NOT TRUSTED: proved.

   A derivation says why a formula is true, or false, at every instant of an interval with rational ends.
   `accepts` is a program that checks one, and the theorem `shown` at the end says: what it accepts is true of
   the drive, in the sense of Meaning.v and Drive.v.  Derivations are found by roadproof; nothing here relies on
   how. *)
From Coq Require Import Reals QArith Qreals String List Bool Arith Lra Lia.
From Roadproof Require Import Meaning Signs Zeros Drive.
Import ListNotations.
Open Scope R_scope.

(* When, within its window, something happens: at one instant, or so long after. *)
Inductive moment := Fixed (u : Q) | Later (u : Q).

(* A derivation of: at all instants of an interval the formula is true (or: is false).  The comments say what is
   derived of what is true; of what is false it is the same with `and` and `or`, some and every, F and G
   exchanged. *)
Inductive derivation :=
| Plain                                                   (* true is true; G where its window is empty *)
| Sign (cuts : list Q)                                    (* signs of polynomials between these instants *)
| Turn (p : derivation)                                   (* not *)
| Both (p q : derivation)                                 (* and *)
| One (second : bool) (p : derivation)                    (* or *)
| Split (c : Q) (after : bool) (p q : derivation)         (* before c (and at it, if after) and from there on *)
| Case (s : list Q) (p q : derivation)                    (* where the polynomial s is above 0, and where it is not *)
| Element (e : nat) (p : derivation)                      (* some *)
| Each (ps : list derivation)                             (* every, in the order of elements *)
| Whole (p : derivation)                                  (* G; not U: its right side is never true *)
| Moment (m : moment) (p : derivation)                    (* F *)
| Reach (m : moment) (p q : derivation)                   (* U: q for its right side, p for its left until then *)
| Break (m : moment) (p q : derivation)                   (* not U: q for its right side until its left is false *)
| Soon (c d : Q) (p q : derivation)                       (* not U: p for its right side to c, q for its left to d *)
| Crossing (a b : Q) (s : list Q) (p q r : derivation)    (* F, U, not U about an instant at which s is 0 *)
| Earlier (rounds : nat) (p : derivation)                 (* as so many rounds of a repeating trace earlier *)
| Round (p : derivation).                                 (* as in the first round of the interval *)

(* --- what a drive is, as polynomials -------------------------------------------------------------------- *)
Record shape := { of_place : list Q; of_speed : list Q; of_acceleration : list Q; of_jerk : list Q }.
(* x + v t + a t^2 + j t^3, without zeros at the end, k later *)
Definition cubic (k x v a j : Q) : list Q := pshift (Qopp k) (with_head x (with_head v (with_head a (with_head j [])))).
(* from k on, from place x, speed v and acceleration a, under jerk j *)
Definition shaped (k x v a j : Q) : shape :=
  {| of_place := cubic k x v (times (1 # 2) a) (times (1 # 6) j);
     of_speed := cubic k v a (times (1 # 2) j) 0;
     of_acceleration := cubic k a j 0 0;
     of_jerk := cubic k j 0 0 0 |}.
Fixpoint shapes (k x v : Q) (ps : list (Q * Q * Q)) (last : Q) : list (Q * shape) :=
  match ps with
  | [] => [(k, shaped k x v last 0)]
  | (d, a, j) :: ps =>
      let d2 := times d d in
      (k, shaped k x v a j)
      :: shapes (plus k d)
           (plus (plus (plus x (times v d)) (times (1 # 2) (times a d2))) (times (1 # 6) (times j (times d d2))))
           (plus (plus v (times a d)) (times (1 # 2) (times j d2))) ps last
  end.
Definition shapes_of (c : course) : list (Q * shape) := shapes 0 (starts_at c) (starts_with c) (pieces c) (finally c).

(* all of I is before c *)
Definition ends_by (I : interval) (c : Q) : bool :=
  match to_ I with None => false | Some (b, before) => if before : bool then Qle_bool b c else below b c end.
Fixpoint shape_on (l : list (Q * shape)) (I : interval) : option shape :=
  match l with
  | [] => None
  | (_, p) :: rest =>
      match rest with
      | [] => Some p
      | (k, _) :: _ => if ends_by I k then Some p else if Qle_bool k (from_ I) then shape_on rest I else None
      end
  end.

Record shaped_body := { shaped_along : list (Q * shape); shaped_across : list (Q * shape); long_ : Q; wide_ : Q; sort_ : sort }.
Definition body_shaped (b : body) : shaped_body :=
  {| shaped_along := shapes_of (along b); shaped_across := shapes_of (across b); long_ := long b; wide_ := wide b;
     sort_ := is_a b |}.
Definition fleet := list (vehicle * shaped_body).
Definition fleet_of (D : drive) : fleet := map (fun e => (fst e, body_shaped (snd e))) (bodies D).

Lemma ends_by_right I c t : ends_by I c = true -> inside I t -> t < Q2R c.
Proof.
  unfold ends_by, inside. destruct (to_ I) as [[b o]|]; [|discriminate]. intros H [_ T].
  destruct o; [apply le_R in H|apply below_R in H]; lra.
Qed.
Lemma half_R : Q2R (1 # 2) = / 2. Proof. unfold Q2R. simpl. lra. Qed.
Lemma constant_R a t : eval [a] t = Q2R a. Proof. cbn [eval]. ring. Qed.
Lemma sixth_R : Q2R (1 # 6) = / 6. Proof. unfold Q2R. simpl. lra. Qed.
Lemma cubic_R k x v a j t : let u := t - Q2R k in
  eval (cubic k x v a j) t = Q2R x + Q2R v * u + Q2R a * u ^ 2 + Q2R j * u ^ 3.
Proof. unfold cubic. rewrite pshift_eval, !with_head_eval, Q2R_opp. cbn [eval]. ring. Qed.
Definition agrees (p : shape) (i : instant) (t : R) : Prop :=
  eval (of_place p) t = place_ i /\ eval (of_speed p) t = speed_ i /\ eval (of_acceleration p) t = acceleration_ i
  /\ eval (of_jerk p) t = jerk_ i.
Lemma shaped_right k x v a j t : agrees (shaped k x v a j) (moved (Q2R x) (Q2R v) (Q2R a) (Q2R j) (t - Q2R k)) t.
Proof.
  unfold agrees, shaped, moved.
  cbn [of_place of_speed of_acceleration of_jerk place_ speed_ acceleration_ jerk_].
  rewrite !cubic_R, !times_R, half_R, sixth_R, zero_R. repeat split; field.
Qed.
Lemma shapes_right ps last : forall k x v I p t, shape_on (shapes k x v ps last) I = Some p -> inside I t ->
  agrees p (moving (Q2R x) (Q2R v) ps last (t - Q2R k)) t.
Proof.
  induction ps as [|[[d a] j] ps IH]; intros k x v I p t H T.
  - injection H as <-. cbn [moving]. rewrite <- zero_R. apply shaped_right.
  - cbn [shapes shape_on] in H.
    set (rest := shapes _ _ _ ps last) in H.
    assert (E : exists q more, rest = (plus k d, q) :: more).
    { unfold rest. destruct ps as [|[[d' a'] j'] ps]; cbn [shapes]; eexists; eexists; reflexivity. }
    destruct E as [q [more E]]. cbn [moving].
    assert (H' : (if ends_by I (plus k d) then Some (shaped k x v a j)
                  else if Qle_bool (plus k d) (from_ I) then shape_on rest I else None) = Some p).
    { rewrite <- H. rewrite E. reflexivity. }
    clear H. destruct (ends_by I (plus k d)) eqn:B.
    + injection H' as <-. apply (ends_by_right _ _ t) in B; [|exact T]. rewrite plus_R in B.
      destruct (Rlt_dec (t - Q2R k) (Q2R d)) as [_|N]; [apply shaped_right|exfalso; lra].
    + destruct (Qle_bool (plus k d) (from_ I)) eqn:L; [|discriminate].
      apply le_R in L. rewrite plus_R in L. pose proof (inside_from I t T) as F.
      destruct (Rlt_dec (t - Q2R k) (Q2R d)) as [Y|_]; [exfalso; lra|].
      specialize (IH _ _ _ I p t H' T). rewrite !plus_R, !times_R, half_R, sixth_R in IH.
      unfold moved. cbn [place_ speed_].
      replace (t - Q2R k - Q2R d) with (t - (Q2R k + Q2R d)) by ring.
      replace (Q2R a * Q2R d ^ 2 / 2) with (/ 2 * (Q2R a * (Q2R d * Q2R d))) by field.
      replace (Q2R j * Q2R d ^ 2 / 2) with (/ 2 * (Q2R j * (Q2R d * Q2R d))) by field.
      replace (Q2R j * Q2R d ^ 3 / 6) with (/ 6 * (Q2R j * (Q2R d * (Q2R d * Q2R d)))) by field. exact IH.
Qed.

(* I is the instant k *)
Definition only (I : interval) (k : Q) : bool :=
  Qle_bool k (from_ I) && match to_ I with Some (b, _) => Qle_bool b k | None => false end.
Lemma only_right I k t : only I k = true -> inside I t -> t = Q2R k.
Proof.
  unfold only. intros H T. apply andb_prop in H as [A B]. destruct (to_ I) as [[b o]|] eqn:E; [|discriminate].
  apply le_R in A, B. pose proof (inside_from I t T). pose proof (inside_to I t b o E T). lra.
Qed.
(* a signal in steps, where it does not change in I *)
Fixpoint step_on (before : Q) (steps : list (Q * Q * Q)) (I : interval) : option Q :=
  match steps with
  | [] => Some before
  | (k, x, y) :: rest =>
      if ends_by I k then Some before
      else if only I k then Some x
      else if Qle_bool k (from_ I) then
        match step_on y rest I with
        | Some z => if below k (from_ I) || after_ I || Qeq_bool z x then Some z else None
        | None => None
        end
      else None
  end.
Lemma step_on_right steps I t : inside I t -> forall before x, step_on before steps I = Some x ->
  Q2R (stepped before steps t) = Q2R x.
Proof.
  intros T. induction steps as [|[[k y] z] steps IH]; intros before x H; cbn [step_on stepped] in *; [congruence|].
  destruct (ends_by I k) eqn:B.
  { apply (ends_by_right _ _ t) in B; [|exact T]. destruct (Rlt_dec t (Q2R k)); [congruence|exfalso; lra]. }
  destruct (only I k) eqn:O.
  { apply (only_right _ _ t) in O; [|exact T]. destruct (Rlt_dec t (Q2R k)); [exfalso; lra|].
    destruct (Req_EM_T t (Q2R k)); [congruence|exfalso; lra]. }
  destruct (Qle_bool k (from_ I)) eqn:L; [|discriminate]. apply le_R in L. pose proof (inside_from I t T) as F.
  destruct (step_on z steps I) as [w|] eqn:E; [|discriminate].
  destruct (below k (from_ I) || after_ I || Qeq_bool w y)%bool eqn:G; [|discriminate]. injection H as <-.
  destruct (Rlt_dec t (Q2R k)); [exfalso; lra|]. destruct (Req_EM_T t (Q2R k)) as [->|]; [|apply IH, E].
  apply orb_prop in G as [G|G]; [apply orb_prop in G as [G|G]|].
  - apply below_R in G. exfalso. lra.
  - destruct T as [A _]. rewrite G in A. exfalso. lra.
  - apply Qeq_bool_iff, Qeq_eqR in G. symmetry. exact G.
Qed.

Lemma find_map (A B : Type) (f : A -> B) x (l : list (string * A)) :
  find (fun e => String.eqb x (fst e)) (map (fun e => (fst e, f (snd e))) l)
  = option_map (fun e => (fst e, f (snd e))) (find (fun e => String.eqb x (fst e)) l).
Proof. induction l as [|[y a] l IH]; simpl; [reflexivity|]. destruct (String.eqb x y); [reflexivity|exact IH]. Qed.
Lemma look_up_map (A B : Type) (f : A -> B) x (l : list (string * A)) o :
  look_up x (map (fun e => (fst e, f (snd e))) l) (f o) = f (look_up x l o).
Proof. unfold look_up. rewrite find_map. destruct (find _ l); reflexivity. Qed.

Section Check.
  Variable D : drive.
  Variable F : fleet.
  Hypothesis HF : F = fleet_of D.
  Notation W := (world_of D).

  Definition shaped_of (a : vehicle) : shaped_body := look_up a F (body_shaped nobody).
  Lemma shaped_of_right a : shaped_of a = body_shaped (body_of D a).
  Proof. unfold shaped_of, body_of. rewrite HF. unfold fleet_of. apply look_up_map. Qed.

  Definition as_list (p : option shape) (g : shape -> list Q) : list (list Q) :=
    match p with None => [] | Some p => [g p] end.
  Definition motion_on (n : signal) (a : vehicle) (I : interval) : list (list Q) :=
    let b := shaped_of a in
    match n with
    | Place_lon => as_list (shape_on (shaped_along b) I) of_place
    | Speed_lon => as_list (shape_on (shaped_along b) I) of_speed
    | Acceleration_lon => as_list (shape_on (shaped_along b) I) of_acceleration
    | Place_lat => as_list (shape_on (shaped_across b) I) of_place
    | Speed_lat => as_list (shape_on (shaped_across b) I) of_speed
    | Acceleration_lat => as_list (shape_on (shaped_across b) I) of_acceleration
    | Jerk_lon => as_list (shape_on (shaped_along b) I) of_jerk
    | Own n => [[]]
    end.
  (* I is before the end of the first round *)
  Definition in_first (I : interval) : bool :=
    match repeats D with None => true | Some (start, period) => below 0 period && ends_by I (plus start period) end.
  Definition signal_on (n : signal) (a : vehicle) (I : interval) : list (list Q) :=
    if in_first I then
      match steps_of D n a with
      | Some steps => match step_on (first_step steps) steps I with Some x => [[x]] | None => [] end
      | None => motion_on n a I
      end
    else [].
  Definition size_on (n : size) (a : vehicle) : Q :=
    let b := shaped_of a in match n with Length => long_ b | Width => wide_ b | Kind => number_of_sort (sort_ b) end.

  (* every pair *)
  Definition pairs_with (g : list Q -> list Q -> list (list Q)) (l m : list (list Q)) : list (list Q) :=
    flat_map (fun p => flat_map (g p) m) l.
  Definition constant (p : list Q) : option Q := match p with [] => Some 0%Q | [c] => Some c | _ => None end.
  Definition larger (I : interval) (p q : list Q) : list (list Q) :=
    if above false (psub p q) I then [p] else if above false (psub q p) I then [q] else [p; q].
  Definition smaller (I : interval) (p q : list Q) : list (list Q) :=
    if above false (psub p q) I then [q] else if above false (psub q p) I then [p] else [p; q].
  Definition divided (l m : list (list Q)) : list (list Q) :=
    match m with
    | [q] => match constant q with
             | Some c => if Qeq_bool c 0 then [] else map (pscale (Qred (/ c))) l
             | None => []
             end
    | _ => []
    end.

  (* Polynomials, of which one is the term at each instant of I; none where it cannot be said. *)
  Fixpoint term_on (I : interval) (x : term) : list (list Q) :=
    match x with
    | Num q => [[q]]
    | Par n => [[look_up n (values D) 0%Q]]
    | Var x => [[look_up x (numbers D) 0%Q]]
    | Sig n a => signal_on n a I
    | Siz n a => [[size_on n a]]
    | Add x y => pairs_with (fun p q => [padd p q]) (term_on I x) (term_on I y)
    | Mul x y => pairs_with (fun p q => [pmul p q]) (term_on I x) (term_on I y)
    | Pow x n => map (fun p => ppow p n) (term_on I x)
    | Div x y => divided (term_on I x) (term_on I y)
    | Max x y => pairs_with (larger I) (term_on I x) (term_on I y)
    | Min x y => pairs_with (smaller I) (term_on I x) (term_on I y)
    end.

  Definition is_one (l : list (list Q)) (x t : R) : Prop := l <> [] -> exists p, In p l /\ x = eval p t.
  Lemma is_this p x t : x = eval p t -> is_one [p] x t.
  Proof. intros E _. exists p. split; [left; reflexivity|exact E]. Qed.
  Lemma nothing_in (g : list Q -> list Q -> list (list Q)) l : flat_map (fun p => flat_map (g p) []) l = [].
  Proof. induction l as [|p l IH]; [reflexivity|exact IH]. Qed.
  Lemma pairs_right g l m x y z t : is_one l x t -> is_one m y t ->
    (forall p q, x = eval p t -> y = eval q t -> exists r, In r (g p q) /\ z = eval r t) ->
    is_one (pairs_with g l m) z t.
  Proof.
    unfold is_one, pairs_with. intros L M H N.
    destruct L as [p [P EP]]; [intros ->; apply N; reflexivity|].
    destruct M as [q [Q' EQ]]; [intros ->; apply N, nothing_in|].
    destruct (H p q EP EQ) as [r [R' ER]]. exists r. split; [|exact ER].
    apply in_flat_map. exists p. split; [exact P|]. apply in_flat_map. exists q. split; assumption.
  Qed.
  Lemma map_right g l x z t : is_one l x t -> (forall p, x = eval p t -> z = eval (g p) t) -> is_one (map g l) z t.
  Proof.
    intros L H N. destruct L as [p [P E]]; [intros ->; apply N; reflexivity|].
    exists (g p). split; [apply in_map, P|apply H, E].
  Qed.
  Lemma constant_right p c t : constant p = Some c -> eval p t = Q2R c.
  Proof.
    destruct p as [|a [|b p]]; simpl; intros H; try discriminate; injection H as <-; [symmetry; apply zero_R|ring].
  Qed.
  Lemma larger_right I p q x y t : inside I t -> x = eval p t -> y = eval q t ->
    exists r, In r (larger I p q) /\ Rmax x y = eval r t.
  Proof.
    intros T -> ->. unfold larger.
    destruct (above false (psub p q) I) eqn:A.
    - exists p. split; [left; reflexivity|]. apply above_right with (t := t) in A; [|exact T].
      simpl in A. rewrite psub_eval in A. apply Rmax_left. lra.
    - destruct (above false (psub q p) I) eqn:B.
      + exists q. split; [left; reflexivity|]. apply above_right with (t := t) in B; [|exact T].
        simpl in B. rewrite psub_eval in B. apply Rmax_right. lra.
      + unfold Rmax. destruct (Rle_dec (eval p t) (eval q t)); [exists q|exists p]; simpl; tauto.
  Qed.
  Lemma smaller_right I p q x y t : inside I t -> x = eval p t -> y = eval q t ->
    exists r, In r (smaller I p q) /\ Rmin x y = eval r t.
  Proof.
    intros T -> ->. unfold smaller.
    destruct (above false (psub p q) I) eqn:A.
    - exists q. split; [left; reflexivity|]. apply above_right with (t := t) in A; [|exact T].
      simpl in A. rewrite psub_eval in A. apply Rmin_right. lra.
    - destruct (above false (psub q p) I) eqn:B.
      + exists p. split; [left; reflexivity|]. apply above_right with (t := t) in B; [|exact T].
        simpl in B. rewrite psub_eval in B. apply Rmin_left. lra.
      + unfold Rmin. destruct (Rle_dec (eval p t) (eval q t)); [exists p|exists q]; simpl; tauto.
  Qed.
  Lemma divided_right l m x y t : is_one l x t -> is_one m y t -> is_one (divided l m) (x / y) t.
  Proof.
    unfold divided. intros L M.
    destruct m as [|q [|q' m]]; try (intros N; exfalso; apply N; reflexivity).
    destruct (constant q) as [c|] eqn:C; [|intros N; exfalso; apply N; reflexivity].
    destruct (Qeq_bool c 0) eqn:Z; [intros N; exfalso; apply N; reflexivity|].
    destruct M as [q' [[<-|[]] ->]]; [discriminate|]. rewrite (constant_right q c t C).
    apply map_right with (x := x); [exact L|]. intros p ->.
    rewrite pscale_eval, red_R, Q2R_inv by (intros H; apply Qeq_bool_iff in H; congruence).
    unfold Rdiv. ring.
  Qed.
  Lemma track_right c I p t : shape_on (shapes_of c) I = Some p -> inside I t -> agrees p (at_time c t) t.
  Proof.
    intros H T. pose proof (shapes_right _ _ _ _ _ _ _ _ H T) as A. unfold at_time.
    rewrite zero_R, Rminus_0_r in A. exact A.
  Qed.
  Lemma first_round start period t : 0 < Q2R period -> t < Q2R start + Q2R period ->
    repeats D = Some (start, period) -> folded D t = t.
  Proof.
    intros P T E. unfold folded. rewrite E. destruct (Rlt_dec t (Q2R start)) as [_|N]; [reflexivity|].
    destruct (base_Int_part ((t - Q2R start) / Q2R period)) as [A B]. set (n := Int_part _) in *.
    assert (L : 0 <= (t - Q2R start) / Q2R period) by (apply Rmult_le_pos; [lra|apply Rlt_le, Rinv_0_lt_compat, P]).
    assert (U : (t - Q2R start) / Q2R period < 1) by (apply (Rmult_lt_reg_r (Q2R period)); [exact P|]; field_simplify; lra).
    assert (n < 1)%Z by (apply lt_IZR; lra). assert (-1 < n)%Z by (apply lt_IZR; lra).
    replace n with 0%Z by lia. lra.
  Qed.
  Lemma in_first_right I t : in_first I = true -> inside I t -> folded D t = t.
  Proof.
    unfold in_first. intros H T. destruct (repeats D) as [[start period]|] eqn:E.
    - apply andb_prop in H as [P H]. apply below_R in P. rewrite zero_R in P.
      apply (ends_by_right _ _ t) in H; [|exact T]. rewrite plus_R in H. apply (first_round start period); assumption.
    - unfold folded. rewrite E. reflexivity.
  Qed.
  Lemma signal_right n a I t : inside I t -> is_one (signal_on n a I) (value W n a t) t.
  Proof.
    intros T. unfold signal_on. cbn [value world_of]. unfold value_of.
    assert (N : forall x, is_one [] x t) by (intros x H; exfalso; apply H; reflexivity).
    destruct (in_first I) eqn:R; [|apply N]. rewrite (in_first_right I t R T).
    destruct (steps_of D n a) as [steps|].
    { destruct (step_on _ _ I) as [x|] eqn:E; [|apply N]. apply is_this. rewrite constant_R.
      apply (step_on_right _ _ _ T _ _ E). }
    unfold motion_on. rewrite shaped_of_right. cbn [shaped_along shaped_across body_shaped].
    destruct n; unfold as_list;
      try match goal with |- context [shape_on ?l ?i] => destruct (shape_on l i) as [p|] eqn:E; [|apply N] end;
      try (apply is_this; destruct (track_right _ _ _ _ E T) as [A [B [C J]]]; symmetry; assumption).
    apply is_this. reflexivity.
  Qed.
  Lemma size_right n a t : measure W n a = eval [size_on n a] t.
  Proof. rewrite constant_R. unfold size_on. rewrite shaped_of_right. destruct n; reflexivity. Qed.
  Lemma term_right I x t : inside I t -> is_one (term_on I x) (number W t x) t.
  Proof.
    intros T. induction x; cbn [term_on number].
    - apply is_this. symmetry. apply constant_R.
    - apply is_this. symmetry. apply constant_R.
    - apply is_this. symmetry. apply constant_R.
    - apply signal_right, T.
    - apply is_this, size_right.
    - apply (pairs_right _ _ _ _ _ _ _ IHx1 IHx2). intros p q -> ->. exists (padd p q).
      split; [left; reflexivity|symmetry; apply padd_eval].
    - apply (pairs_right _ _ _ _ _ _ _ IHx1 IHx2). intros p q -> ->. exists (pmul p q).
      split; [left; reflexivity|symmetry; apply pmul_eval].
    - apply (map_right _ _ _ _ _ IHx). intros p ->. symmetry. apply ppow_eval.
    - apply divided_right; assumption.
    - apply (pairs_right _ _ _ _ _ _ _ IHx1 IHx2). intros p q. apply larger_right, T.
    - apply (pairs_right _ _ _ _ _ _ _ IHx1 IHx2). intros p q. apply smaller_right, T.
  Qed.
  (* A term that is one number throughout I. *)
  Definition rigid (I : interval) (x : term) : option Q :=
    match term_on I x with [p] => constant p | _ => None end.
  Lemma rigid_right I x c t : rigid I x = Some c -> inside I t -> number W t x = Q2R c.
  Proof.
    unfold rigid. intros H T. pose proof (term_right I x t T) as N.
    destruct (term_on I x) as [|p [|q l]]; try discriminate.
    destruct N as [p' [[<-|[]] ->]]; [discriminate|]. apply constant_right, H.
  Qed.

  (* --- comparisons -------------------------------------------------------------------------------------- *)
  Definition some_pair (f : list Q -> list Q -> bool) (l m : list (list Q)) : bool :=
    match l, m with [], _ | _, [] => false | _, _ => forallb (fun p => forallb (f p) m) l end.
  Lemma some_pair_right f l m x y t : some_pair f l m = true -> is_one l x t -> is_one m y t ->
    exists p q, x = eval p t /\ y = eval q t /\ f p q = true.
  Proof.
    unfold some_pair. intros H L M. destruct l as [|p0 l]; [discriminate|]. destruct m as [|q0 m]; [discriminate|].
    destruct L as [p [P EP]]; [discriminate|]. destruct M as [q [Q' EQ]]; [discriminate|].
    exists p, q. split; [exact EP|split; [exact EQ|]].
    rewrite forallb_forall in H. specialize (H p P). rewrite forallb_forall in H. exact (H q Q').
  Qed.
  Definition pneg (p : list Q) : list Q := pscale (-1) p.
  Definition pone : list Q := [1%Q].

  (* l < r throughout I, or l <= r *)
  Definition in_order (strict : bool) (l r : side) (I : interval) : bool :=
    match l, r with
    | Fin x, Fin y => some_pair (fun p q => above strict (psub q p) I) (term_on I x) (term_on I y)
    | Inv x, Fin y =>
        some_pair (fun p q => (above true p I && above strict (psub (pmul p q) pone) I)
                              || (above true (pneg p) I && above strict (psub pone (pmul p q)) I))
          (term_on I x) (term_on I y)
    | Fin x, Inv y =>
        some_pair (fun p q => (above false q I && above strict (psub pone (pmul p q)) I)
                              || (above true (pneg q) I && above strict (psub (pmul p q) pone) I))
          (term_on I x) (term_on I y)
    | Inv x, Inv y =>
        some_pair (fun p q => (above false q I && above strict (psub p q) I)
                              || (above true (pneg p) I && above strict (psub p q) I)
                              || (above true (pneg p) I && above false q I))
          (term_on I x) (term_on I y)
    end.
  Definition ordered (strict : bool) (a b : extended) : Prop := if strict then less a b else at_most a b.

  Lemma inverse_less x y : 0 < x -> 1 < x * y -> / x < y.
  Proof. intros X H. apply (Rmult_lt_reg_l x); [exact X|]. rewrite Rinv_r by lra. exact H. Qed.
  Lemma inverse_at_most x y : 0 < x -> 1 <= x * y -> / x <= y.
  Proof. intros X H. apply (Rmult_le_reg_l x); [exact X|]. rewrite Rinv_r by lra. exact H. Qed.
  Lemma less_inverse x y : 0 < y -> x * y < 1 -> x < / y.
  Proof. intros Y H. apply (Rmult_lt_reg_r y); [exact Y|]. rewrite Rinv_l by lra. exact H. Qed.
  Lemma at_most_inverse x y : 0 < y -> x * y <= 1 -> x <= / y.
  Proof. intros Y H. apply (Rmult_le_reg_r y); [exact Y|]. rewrite Rinv_l by lra. exact H. Qed.
  Lemma inverse_negative x : x < 0 -> / x = - / - x.
  Proof. intros X. field. lra. Qed.

  Lemma in_order_right strict l r I t : in_order strict l r I = true -> inside I t ->
    ordered strict (extended_number W t l) (extended_number W t r).
  Proof.
    assert (E1 : forall s, eval pone s = 1) by (intros s; unfold pone; rewrite constant_R; apply one_R).
    assert (EN : forall p s, eval (pneg p) s = - eval p s).
    { intros p s. unfold pneg. rewrite pscale_eval. replace (Q2R (-1)) with (-1) by (unfold Q2R; simpl; lra). ring. }
    intros H T. unfold in_order in H.
    destruct l as [x|x], r as [y|y];
      apply some_pair_right with (x := number W t x) (y := number W t y) (t := t) in H; try (apply term_right, T);
      destruct H as [p [q [X [Y H]]]]; cbn [extended_number]; rewrite X, Y; clear X Y.
    - apply above_right with (t := t) in H; [|exact T]. rewrite psub_eval in H.
      destruct strict; simpl in *; lra.
    - apply orb_prop in H as [H|H]; apply andb_prop in H as [A B];
        apply above_right with (t := t) in A, B; try exact T;
        rewrite ?psub_eval, ?pmul_eval, ?E1, ?EN in *; set (a := eval p t) in *; set (b := eval q t) in *; clearbody a b.
      + destruct (Req_EM_T b 0); [destruct strict; exact Logic.I|].
        simpl in A. destruct strict; simpl in *; [apply less_inverse|apply at_most_inverse]; lra.
      + simpl in A. destruct (Req_EM_T b 0); [exfalso; lra|]. rewrite (inverse_negative b) by lra.
        destruct strict; simpl in *.
        * assert (/ - b < - a) by (apply inverse_less; nra). lra.
        * assert (/ - b <= - a) by (apply inverse_at_most; nra). lra.
    - apply orb_prop in H as [H|H]; apply andb_prop in H as [A B];
        apply above_right with (t := t) in A, B; try exact T;
        rewrite ?psub_eval, ?pmul_eval, ?E1, ?EN in *; set (a := eval p t) in *; set (b := eval q t) in *; clearbody a b;
        simpl in A; (destruct (Req_EM_T a 0); [exfalso; lra|]).
      + destruct strict; simpl in *; [apply inverse_less|apply inverse_at_most]; lra.
      + rewrite (inverse_negative a) by lra. destruct strict; simpl in *.
        * assert (- b < / - a) by (apply less_inverse; nra). lra.
        * assert (- b <= / - a) by (apply at_most_inverse; nra). lra.
    - apply orb_prop in H as [H|H]; [apply orb_prop in H as [H|H]|]; apply andb_prop in H as [A B];
        apply above_right with (t := t) in A, B; try exact T;
        rewrite ?psub_eval, ?pmul_eval, ?E1, ?EN in *; set (a := eval p t) in *; set (b := eval q t) in *; clearbody a b;
        simpl in A.
      + destruct (Req_EM_T b 0); [subst b|].
        * destruct (Req_EM_T a 0); destruct strict; simpl in *; solve [exact Logic.I|lra].
        * destruct (Req_EM_T a 0); [exfalso; destruct strict; simpl in *; lra|].
          destruct strict; simpl in *; [apply Rinv_lt_contravar|apply Rinv_le_contravar]; nra.
      + destruct (Req_EM_T a 0); [exfalso; lra|].
        destruct (Req_EM_T b 0); [destruct strict; exact Logic.I|].
        rewrite (inverse_negative a) by lra. assert (b < 0) by (destruct strict; simpl in *; lra).
        rewrite (inverse_negative b) by lra.
        destruct strict; simpl in *.
        * assert (/ - b < / - a) by (apply Rinv_lt_contravar; nra). lra.
        * assert (/ - b <= / - a) by (apply Rinv_le_contravar; nra). lra.
      + destruct (Req_EM_T a 0); [exfalso; lra|].
        destruct (Req_EM_T b 0); [destruct strict; exact Logic.I|].
        rewrite (inverse_negative a) by lra. simpl in B.
        assert (0 < / - a) by (apply Rinv_0_lt_compat; lra). assert (0 < / b) by (apply Rinv_0_lt_compat; lra).
        destruct strict; simpl; lra.
  Qed.

  Definition compare_on (pol : bool) (o : comparison) (l r : side) (I : interval) : bool :=
    match o, pol with
    | LT, true | GE, false => in_order true l r I
    | LE, true | GT, false => in_order false l r I
    | GT, true | LE, false => in_order true r l I
    | GE, true | LT, false => in_order false r l I
    end.
  (* P, or not P *)
  Definition says (pol : bool) (P : Prop) : Prop := if pol then P else ~ P.

  Lemma not_less a b : at_most b a -> ~ less a b.
  Proof. destruct a, b; simpl; intros H N; lra || tauto. Qed.
  Lemma not_at_most a b : less b a -> ~ at_most a b.
  Proof. destruct a, b; simpl; intros H N; lra || tauto. Qed.
  Lemma compare_right pol o l r I t : compare_on pol o l r I = true -> inside I t ->
    says pol (compares o (extended_number W t l) (extended_number W t r)).
  Proof.
    intros H T. destruct o, pol; simpl in *; apply in_order_right with (t := t) in H; try exact T; simpl in H;
      try exact H; solve [apply not_less, H|apply not_at_most, H].
  Qed.

  (* --- the road ----------------------------------------------------------------------------------------- *)
  Notation named := (element_named D).
  Notation bounds_ := (nat -> element W).
  Definition number_of (e : element W) : nat := proj1_sig e.
  Definition at_number (e : nat) : rectangle := nth e (rectangles D) (first_rectangle D).
  Definition count : nat := List.length (rectangles D).
  Lemma rectangle_number e : rectangle_of D e = at_number (number_of e).
  Proof. reflexivity. Qed.
  Lemma number_below e : Nat.ltb (number_of e) count = true.
  Proof. exact (proj2_sig e). Qed.

  (* What has to be above 0 where a box is in a rectangle. *)
  Definition edges (a : vehicle) (e : nat) (I : interval) : option (list (list Q)) :=
    let r := at_number e in
    match signal_on Place_lon a I, signal_on Place_lat a I with
    | [p], [q] =>
        Some (match from_s r with None => [] | Some x => [psub p [x]] end
              ++ match to_s r with None => [] | Some x => [psub [x] (psub p [size_on Length a])] end
              ++ [psub q [right_d r]; psub [left_d r] (psub q [size_on Width a])])
    | _, _ => None
    end.
  Definition occupies_on (pol : bool) (a : vehicle) (e : nat) (I : interval) : bool :=
    match edges a e I with
    | None => false
    | Some ps => if pol then forallb (fun p => above true p I) ps else existsb (fun p => above false (pneg p) I) ps
    end.
  Lemma pneg_eval p t : eval (pneg p) t = - eval p t.
  Proof. unfold pneg. rewrite pscale_eval. replace (Q2R (-1)) with (-1) by (unfold Q2R; simpl; lra). ring. Qed.
  (* As Meaning.v says it of the world of a drive *)
  Definition is_in (a : vehicle) (e : element_of D) (t : R) : Prop :=
    match from_s (rectangle_of D e) with None => True | Some b => Q2R b < value_of D Place_lon a t end
    /\ match to_s (rectangle_of D e) with None => True | Some b => value_of D Place_lon a t - measure_of D Length a < Q2R b end
    /\ Q2R (right_d (rectangle_of D e)) < value_of D Place_lat a t
    /\ value_of D Place_lat a t - measure_of D Width a < Q2R (left_d (rectangle_of D e)).
  Lemma occupies_is_in a e t : occupies (world_of D) a e t <-> is_in a e t.
  Proof.
    unfold occupies, is_in. cbn [Meaning.shape value measure world_of shape_of s_from s_to d_from d_to].
    destruct (from_s (rectangle_of D e)), (to_s (rectangle_of D e)); cbn [option_map]; tauto.
  Qed.
  Lemma edges_right a e I ps t : edges a (number_of e) I = Some ps -> inside I t ->
    is_in a e t <-> Forall (fun p => 0 < eval p t) ps.
  Proof.
    unfold edges, is_in. intros H T. rewrite rectangle_number. set (r := at_number (number_of e)) in *.
    pose proof (signal_right Place_lon a I t T) as P. pose proof (signal_right Place_lat a I t T) as Q'.
    destruct (signal_on Place_lon a I) as [|p [|? ?]]; try discriminate.
    destruct (signal_on Place_lat a I) as [|q [|? ?]]; try discriminate.
    destruct P as [? [[<-|[]] P]]; [discriminate|]. destruct Q' as [? [[<-|[]] Q']]; [discriminate|].
    injection H as <-. change (long_ (shaped_of a)) with (size_on Length a).
    change (wide_ (shaped_of a)) with (size_on Width a). cbn [value world_of] in P, Q'. rewrite P, Q'.
    pose proof (size_right Length a t) as SL. pose proof (size_right Width a t) as SW. rewrite constant_R in SL, SW.
    cbn [measure world_of] in SL, SW. rewrite SL, SW.
    rewrite !Forall_app. rewrite !Forall_cons_iff. rewrite !psub_eval, !constant_R.
    destruct (from_s r), (to_s r); rewrite ?Forall_cons_iff, ?psub_eval, ?constant_R;
      (split; [intros [A [B [C E]]]; repeat split; try lra; auto|intros [A [B [C [E _]]]]; repeat split; try tauto; lra]).
  Qed.
  Lemma occupies_right pol a e I t : occupies_on pol a (number_of e) I = true -> inside I t ->
    says pol (occupies (world_of D) a e t).
  Proof.
    unfold occupies_on. intros H T. destruct (edges a (number_of e) I) as [ps|] eqn:E; [|discriminate].
    pose proof (edges_right a e I ps t E T) as R. rewrite <- occupies_is_in in R. destruct pol; cbn [says].
    - apply R. rewrite forallb_forall in H. apply Forall_forall. intros p P.
      apply (above_right true p I t (H p P) T).
    - intros N. apply R in N. rewrite Forall_forall in N. apply existsb_exists in H as [p [P A]].
      specialize (N p P). apply above_right with (t := t) in A; [|exact T]. simpl in A. rewrite pneg_eval in A. lra.
  Qed.

  Definition index_of (env : nat -> nat) (l : road) : nat :=
    match l with Free x => number_of (named x) | Bound n => env n end.
  Definition put (env : nat -> nat) (n e : nat) : nat -> nat := fun k => if Nat.eqb k n then e else env k.
  Definition same_zone (x y : zone) : bool :=
    match x, y with main, main | merge, merge | depart, depart => true | _, _ => false end.
  Definition is_pair (x y : string) (p : string * string) : bool := String.eqb x (fst p) && String.eqb y (snd p).
  Definition is_member (env : nat -> nat) (d : domain) (e : nat) : bool :=
    let there := lane (at_number e) in
    match d with
    | Lanes => true
    | Adjacent l =>
        let here := lane (at_number (index_of env l)) in
        negb (String.eqb here there) && existsb (fun p => is_pair here there p || is_pair there here p) (beside D)
    | Lanelets l => String.eqb (lane (at_number (index_of env l))) there
    | Zone z => same_zone (lies_in (at_number e)) z
    end.
  Definition members (env : nat -> nat) (d : domain) : list nat := filter (is_member env d) (seq 0 count).

  Definition fits (b : bounds_) (env : nat -> nat) : Prop := forall k, number_of (b k) = env k.
  Lemma index_right b env l : fits b env -> number_of (place W named b l) = index_of env l.
  Proof. intros H. destruct l as [x|n]; simpl; [reflexivity|apply H]. Qed.
  Lemma put_right b env n e : fits b env -> fits (bind W b n e) (put env n (number_of e)).
  Proof. intros H k. unfold bind, put. destruct (Nat.eqb k n); [reflexivity|apply H]. Qed.
  Lemma is_pair_right x y p : is_pair x y p = true <-> p = (x, y).
  Proof.
    unfold is_pair. destruct p as [u v]; simpl. rewrite andb_true_iff, !String.eqb_eq.
    split; [intros [-> ->]; reflexivity|intros H; injection H as -> ->; split; reflexivity].
  Qed.
  Lemma is_member_right b env d e : fits b env -> is_member env d (number_of e) = true <-> member W named b d e.
  Proof.
    intros H. destruct d as [|l|l|z]; simpl.
    - tauto.
    - unfold are_beside, lane_of. rewrite !rectangle_number, (index_right b env l H).
      set (x := lane (at_number (index_of env l))). set (y := lane (at_number (number_of e))).
      rewrite andb_true_iff, negb_true_iff, existsb_exists, String.eqb_neq.
      split; intros [N I]; (split; [exact N|]).
      + destruct I as [p [P I]]. apply orb_prop in I as [I|I]; apply is_pair_right in I; subst p; tauto.
      + destruct I as [I|I]; eexists; (split; [exact I|]); apply orb_true_iff; rewrite !is_pair_right; tauto.
    - unfold lane_of. rewrite !rectangle_number, (index_right b env l H). apply String.eqb_eq.
    - rewrite rectangle_number. destruct (lies_in _), z; simpl; split; intros N; try reflexivity; discriminate.
  Qed.
  Lemma members_right b env d e : fits b env -> member W named b d e -> In (number_of e) (members env d).
  Proof.
    intros H M. apply filter_In. split; [|apply (is_member_right b env d e H), M].
    apply in_seq. pose proof (number_below e) as B. apply Nat.ltb_lt in B. split; [apply Nat.le_0_l|exact B].
  Qed.

  (* --- time --------------------------------------------------------------------------------------------- *)
  Definition before_ (I : interval) (c : Q) (after : bool) : interval :=
    {| from_ := from_ I; after_ := after_ I; to_ := Some (c, negb after) |}.
  Definition since (I : interval) (c : Q) (after : bool) : interval :=
    {| from_ := c; after_ := after; to_ := to_ I |}.
  Lemma split_right I c after t : inside I t -> inside (before_ I c after) t \/ inside (since I c after) t.
  Proof.
    unfold inside, before_, since. cbn [from_ after_ to_]. intros [A B].
    destruct after; cbn [negb]; [destruct (Rle_lt_dec t (Q2R c))|destruct (Rlt_le_dec t (Q2R c))]; tauto.
  Qed.
  Fixpoint parts (I : interval) (cuts : list Q) : list interval :=
    match cuts with [] => [I] | c :: cuts => before_ I c false :: parts (since I c false) cuts end.
  Lemma parts_right cuts t : forall I, inside I t -> exists J, In J (parts I cuts) /\ inside J t.
  Proof.
    induction cuts as [|c cuts IH]; intros I T; cbn [parts].
    - exists I. split; [left; reflexivity|exact T].
    - destruct (split_right I c false t T) as [H|H].
      + exists (before_ I c false). split; [left; reflexivity|exact H].
      + destruct (IH _ H) as [J [P J']]. exists J. split; [right; exact P|exact J'].
  Qed.

  Definition at_ (m : moment) (t : R) : R := match m with Fixed u => Q2R u | Later u => t + Q2R u end.
  Definition moved_by (u : Q) (to : option (Q * bool)) : option (Q * bool) :=
    option_map (fun b : Q * bool => (plus (fst b) u, snd b)) to.
  Definition image (I : interval) (m : moment) : interval :=
    match m with
    | Fixed u => {| from_ := u; after_ := false; to_ := Some (u, false) |}
    | Later u => {| from_ := plus (from_ I) u; after_ := after_ I; to_ := moved_by u (to_ I) |}
    end.
  (* t + lo <= the moment, for all t in I *)
  Definition is_late (I : interval) (m : moment) (lo : term) : bool :=
    match rigid I lo, m with
    | Some a, Later u => Qle_bool a u
    | Some a, Fixed u => match to_ I with Some (b, _) => Qle_bool (plus b a) u | None => false end
    | None, _ => false
    end.
  (* the moment <= t + hi *)
  Definition is_early (I : interval) (m : moment) (hi : option term) : bool :=
    match hi with
    | None => true
    | Some hi => match rigid I hi, m with
                 | Some b, Later u => Qle_bool u b
                 | Some b, Fixed u => Qle_bool u (plus (from_ I) b)
                 | None, _ => false
                 end
    end.
  Definition meets (I : interval) (m : moment) (lo : term) (hi : option term) : bool :=
    is_late I m lo && is_early I m hi.
  (* all windows of instants in I *)
  Definition widened (I : interval) (lo : term) (hi : option term) : option interval :=
    match rigid I lo, hi with
    | Some a, None => Some {| from_ := plus (from_ I) a; after_ := after_ I; to_ := None |}
    | Some a, Some hi =>
        option_map (fun b => {| from_ := plus (from_ I) a; after_ := after_ I; to_ := moved_by b (to_ I) |}) (rigid I hi)
    | None, _ => None
    end.
  (* from the begin of windows to the moment, which is left out, or not *)
  Definition until_then (I : interval) (m : moment) (lo : term) (out : bool) : option interval :=
    option_map (fun a =>
      {| from_ := plus (from_ I) a; after_ := after_ I;
         to_ := match m with
                | Fixed u => Some (u, out)
                | Later u => option_map (fun b : Q * bool => (plus (fst b) u, out || snd b)) (to_ I)
                end |}) (rigid I lo).
  (* the moment is the begin of each window, or before it *)
  Definition at_once (I : interval) (m : moment) (lo : term) : bool :=
    match rigid I lo, m with
    | Some a, Later u => Qle_bool u a
    | Some a, Fixed u => Qle_bool u (plus (from_ I) a)
    | None, _ => false
    end.

  (* windows that end before they begin *)
  Definition is_empty (I : interval) (lo : term) (hi : option term) : bool :=
    match rigid I lo, hi with
    | Some a, Some hi => match rigid I hi with Some b => below b a | None => false end
    | _, _ => false
    end.
  (* from a to b, and between them *)
  Definition closed_ (a b : Q) : interval := {| from_ := a; after_ := false; to_ := Some (b, false) |}.
  Definition open_ (a b : Q) : interval := {| from_ := a; after_ := true; to_ := Some (b, true) |}.
  (* s is above 0 at a, and not at b, which comes later *)
  Definition falls (s : list Q) (a b : Q) : bool :=
    below a b && above true s (closed_ a a) && above false (pneg s) (closed_ b b).

  Lemma is_empty_right I lo hi t u : is_empty I lo hi = true -> inside I t -> ~ within W t lo hi u.
  Proof.
    unfold is_empty, within. intros H T [A B]. destruct (rigid I lo) as [a|] eqn:E; [|discriminate].
    destruct hi as [hi|]; [|discriminate]. destruct (rigid I hi) as [b|] eqn:F'; [|discriminate].
    rewrite (rigid_right I lo a t E T) in A. rewrite (rigid_right I hi b t F' T) in B. apply below_R in H. lra.
  Qed.
  Lemma closed_right a b t : Q2R a <= t <= Q2R b -> inside (closed_ a b) t.
  Proof. intros H. exact H. Qed.
  Lemma falls_right s a b : falls s a b = true ->
    exists z, Q2R a < z <= Q2R b /\ eval s z = 0 /\ forall w, Q2R a <= w < z -> 0 < eval s w.
  Proof.
    unfold falls. intros H. apply andb_prop in H as [H B]. apply andb_prop in H as [L A]. apply below_R in L.
    apply (first_zero s); [lra|apply (above_right true s (closed_ a a)); [exact A|apply closed_right; lra]|].
    pose proof (above_right false (pneg s) (closed_ b b) (Q2R b) B ltac:(apply closed_right; lra)) as N.
    unfold sign_ok, pneg in N. rewrite pscale_eval in N. unfold Q2R at 1 in N. simpl in N. lra.
  Qed.
  Lemma image_right I m t : inside I t -> inside (image I m) (at_ m t).
  Proof.
    unfold inside. destruct m as [u|u]; cbn [image from_ after_ to_ at_]; [intros _; lra|].
    rewrite plus_R. intros [A B]. split; [destruct (after_ I); lra|].
    destruct (to_ I) as [[b o]|]; simpl in *; [rewrite plus_R; destruct o; lra|exact Logic.I].
  Qed.
  Lemma is_late_right I m lo t : is_late I m lo = true -> inside I t -> t + number W t lo <= at_ m t.
  Proof.
    unfold is_late. intros H T. destruct (rigid I lo) as [a|] eqn:A; [|discriminate].
    rewrite (rigid_right I lo a t A T). destruct m as [u|u]; cbn [at_].
    - destruct (to_ I) as [[b o]|] eqn:E; [|discriminate]. pose proof (inside_to I t b o E T) as B.
      apply le_R in H. rewrite plus_R in H. lra.
    - apply le_R in H. lra.
  Qed.
  Lemma is_early_right I m hi t : is_early I m hi = true -> inside I t ->
    match hi with None => True | Some b => at_ m t <= t + number W t b end.
  Proof.
    unfold is_early. intros H T. destruct hi as [hi|]; [|exact Logic.I].
    destruct (rigid I hi) as [b|] eqn:B; [|discriminate]. rewrite (rigid_right I hi b t B T).
    pose proof (inside_from I t T) as F'. destruct m as [u|u]; cbn [at_]; apply le_R in H; rewrite ?plus_R in H; lra.
  Qed.
  Lemma meets_right I m lo hi t : meets I m lo hi = true -> inside I t -> within W t lo hi (at_ m t).
  Proof.
    unfold meets, within. intros H T. apply andb_prop in H as [A B].
    split; [apply (is_late_right I m lo t A T)|apply (is_early_right I m hi t B T)].
  Qed.
  Lemma widened_right I lo hi J t u : widened I lo hi = Some J -> inside I t -> within W t lo hi u -> inside J u.
  Proof.
    unfold widened, within. intros H T [A B]. destruct (rigid I lo) as [a|] eqn:Ea; [|discriminate].
    rewrite (rigid_right I lo a t Ea T) in A. unfold inside in T. destruct hi as [hi|].
    - destruct (rigid I hi) as [b|] eqn:Eb; [|discriminate]. rewrite (rigid_right I hi b t Eb T) in B.
      injection H as <-. unfold inside. cbn [from_ after_ to_]. rewrite plus_R. destruct T as [T1 T2].
      split; [destruct (after_ I); lra|].
      destruct (to_ I) as [[c o]|]; simpl in *; [rewrite plus_R; destruct o; lra|exact Logic.I].
    - injection H as <-. unfold inside. cbn [from_ after_ to_]. rewrite plus_R. destruct T as [T1 T2].
      split; [destruct (after_ I); lra|exact Logic.I].
  Qed.
  Lemma until_then_right I m lo out J t u : until_then I m lo out = Some J -> inside I t ->
    t + number W t lo <= u -> (if out then u < at_ m t else u <= at_ m t) -> inside J u.
  Proof.
    unfold until_then. intros H T A B. destruct (rigid I lo) as [a|] eqn:Ea; [|discriminate].
    rewrite (rigid_right I lo a t Ea T) in A. injection H as <-. unfold inside in *. cbn [from_ after_ to_].
    rewrite plus_R. destruct T as [T1 T2]. split; [destruct (after_ I); lra|].
    destruct m as [v|v]; cbn [at_] in B; [destruct out; exact B|].
    destruct (to_ I) as [[c o]|]; simpl in *; [|exact Logic.I].
    rewrite plus_R. destruct out, o; simpl; lra.
  Qed.
  Lemma at_once_right I m lo t : at_once I m lo = true -> inside I t -> at_ m t <= t + number W t lo.
  Proof.
    unfold at_once. intros H T. destruct (rigid I lo) as [a|] eqn:A; [|discriminate].
    rewrite (rigid_right I lo a t A T). pose proof (inside_from I t T) as F'.
    destruct m as [u|u]; cbn [at_]; apply le_R in H; rewrite ?plus_R in H; lra.
  Qed.

  (* --- what the sign of a polynomial says of comparisons ------------------------------------------------ *)
  (* Whether q is s times a number above 0 (true) or below 0 (false). *)
  Definition same_sign (s q : list Q) : option bool :=
    let c := Qred (last q 0%Q / last s 0%Q) in
    match psub q (pscale c s) with
    | [] => if below 0 c then Some true else if below c 0 then Some false else None
    | _ => None
    end.
  (* l < r, and r < l, where it follows from s > 0 (above), or from s <= 0 *)
  Definition says_less (same above : bool) : option bool :=
    match same, above with true, true => Some true | false, false => None | _, _ => Some false end.
  Definition says_greater (same above : bool) : option bool :=
    match same, above with false, true => Some true | true, false => None | _, _ => Some false end.
  Definition said_of (I : interval) (s : list Q) (above : bool) (l : side) (o : comparison) (r : side) : option bool :=
    match l, r with
    | Fin x, Fin y =>
        match term_on I x, term_on I y with
        | [u], [v] =>
            match same_sign s (psub v u) with
            | None => None
            | Some same =>
                match o with
                | LT => says_less same above
                | GE => option_map negb (says_less same above)
                | GT => says_greater same above
                | LE => option_map negb (says_greater same above)
                end
            end
        | _, _ => None
        end
    | _, _ => None
    end.
  Fixpoint assume (I : interval) (s : list Q) (above : bool) (f : formula) : formula :=
    match f with
    | Compare l o r => match said_of I s above l o r with Some b => Truth b | None => f end
    | Not f => Not (assume I s above f)
    | And f g => And (assume I s above f) (assume I s above g)
    | Or f g => Or (assume I s above f) (assume I s above g)
    | Some_ n d f => Some_ n d (assume I s above f)
    | Every n d f => Every n d (assume I s above f)
    | _ => f
    end.
  Definition has_sign (s : list Q) (above : bool) (t : R) : Prop := if above then 0 < eval s t else eval s t <= 0.

  Lemma same_sign_right s q same above t : same_sign s q = Some same -> has_sign s above t ->
    match same, above with
    | true, true => 0 < eval q t | true, false => eval q t <= 0
    | false, true => eval q t < 0 | false, false => 0 <= eval q t
    end.
  Proof.
    unfold same_sign. intros H S. set (c := Qred (last q 0%Q / last s 0%Q)) in *.
    destruct (psub q (pscale c s)) as [|x l] eqn:E; [|discriminate].
    assert (P : eval q t = Q2R c * eval s t).
    { assert (Z : eval (psub q (pscale c s)) t = 0) by (rewrite E; reflexivity).
      rewrite psub_eval, pscale_eval in Z. lra. }
    rewrite P. clearbody c. destruct (below 0 c) eqn:B; [|destruct (below c 0) eqn:B'; [|discriminate]];
      injection H as <-; (apply below_R in B || apply below_R in B'); rewrite zero_R in *;
      destruct above; simpl in S; nra.
  Qed.
  Lemma said_of_right I s above l o r b t : said_of I s above l o r = Some b -> inside I t -> has_sign s above t ->
    (b = true <-> compares o (extended_number W t l) (extended_number W t r)).
  Proof.
    unfold said_of. intros H T S. destruct l as [x|x]; [|discriminate]. destruct r as [y|y]; [|discriminate].
    pose proof (term_right I x t T) as X. pose proof (term_right I y t T) as Y.
    destruct (term_on I x) as [|u [|? ?]]; try discriminate. destruct (term_on I y) as [|v [|? ?]]; try discriminate.
    destruct X as [u' [[<-|[]] X]]; [discriminate|]. destruct Y as [v' [[<-|[]] Y]]; [discriminate|].
    destruct (same_sign s (psub v u)) as [same|] eqn:E; [|discriminate].
    pose proof (same_sign_right s _ same above t E S) as Q'. rewrite psub_eval in Q'.
    cbn [extended_number]. rewrite X, Y.
    destruct o, same, above; simpl in H; try discriminate; injection H as <-; simpl; simpl in Q';
      (split; intros C; try discriminate; try reflexivity; lra).
  Qed.
  Lemma assume_right I s above f t : inside I t -> has_sign s above t ->
    forall b, Meaning.holds W named b t (assume I s above f) <-> Meaning.holds W named b t f.
  Proof.
    intros T S. induction f; intros p; cbn [assume Meaning.holds]; try tauto.
    - destruct (said_of I s above l o r) as [b|] eqn:E; [|tauto]. apply (said_of_right I s above l o r b t E T S).
    - split; intros [e [M H]]; exists e; (split; [exact M|apply IHf, H]).
    - split; intros H e M; apply IHf, H, M.
    - rewrite IHf. tauto.
    - rewrite IHf1, IHf2. tauto.
    - rewrite IHf1, IHf2. tauto.
  Qed.

  (* The formula where s is 0. *)
  Definition at_zero (I : interval) (s : list Q) (f : formula) : formula := assume I s false (assume I (pneg s) false f).
  Lemma at_zero_right I s f t : inside I t -> eval s t = 0 ->
    forall b, Meaning.holds W named b t (at_zero I s f) <-> Meaning.holds W named b t f.
  Proof.
    intros T Z b. unfold at_zero. rewrite (assume_right I s false), (assume_right I (pneg s) false); try assumption.
    - tauto.
    - unfold has_sign, pneg. rewrite pscale_eval, Z. lra.
    - unfold has_sign. lra.
  Qed.

  (* --- traces that repeat ------------------------------------------------------------------------------- *)
  (* Each moment that the formula speaks of is the present one, or a later one; from `start` on. *)
  Definition is_ahead (start : Q) (lo : term) : bool :=
    match rigid {| from_ := start; after_ := false; to_ := None |} lo with Some a => Qle_bool 0 a | None => false end.
  Fixpoint looks_ahead (start : Q) (f : formula) : bool :=
    match f with
    | Truth _ | Compare _ _ _ | Occupies _ _ => true
    | Some_ _ _ f | Every _ _ f | Not f => looks_ahead start f
    | And f g | Or f g => looks_ahead start f && looks_ahead start g
    | Until f lo _ g => is_ahead start lo && looks_ahead start f && looks_ahead start g
    | Eventually lo _ f | Always lo _ f => is_ahead start lo && looks_ahead start f
    end.
  (* Where the interval is one of a repeating trace, of which the formula speaks alike in each round. *)
  Definition rounds_of (f : formula) (I : interval) : option Q :=
    match repeats D with
    | Some (start, period) =>
        if below 0 period && Qle_bool start (from_ I) && looks_ahead start f then Some period else None
    | None => None
    end.
  Definition earlier (I : interval) (by_ : Q) : interval :=
    {| from_ := minus (from_ I) by_; after_ := after_ I; to_ := moved_by (Qopp by_) (to_ I) |}.
  Definition many (n : nat) (period : Q) : Q := times (inject_Z (Z.of_nat n)) period.
  Definition first_of_rounds (I : interval) (period : Q) : interval :=
    {| from_ := from_ I; after_ := false; to_ := Some (plus (from_ I) period, true) |}.

  Section Rounds.
    Variables start period : Q.
    Hypothesis repeating : repeats D = Some (start, period).
    Hypothesis P : 0 < Q2R period.
    Notation p := (Q2R period).
    Lemma folded_again t : Q2R start <= t -> folded D (t + p) = folded D t.
    Proof.
      intros T. unfold folded. rewrite repeating.
      destruct (Rlt_dec (t + p) (Q2R start)); [exfalso; lra|]. destruct (Rlt_dec t (Q2R start)); [exfalso; lra|].
      replace ((t + p - Q2R start) / p) with ((t - Q2R start) / p + 1) by (field; lra).
      set (r := (t - Q2R start) / p). destruct (base_Int_part r) as [A B]. destruct (base_Int_part (r + 1)) as [A' B'].
      assert (E : Int_part (r + 1) = (Int_part r + 1)%Z).
      { assert (Int_part (r + 1) < Int_part r + 2)%Z by (apply lt_IZR; rewrite plus_IZR; lra).
        assert (Int_part r < Int_part (r + 1))%Z by (apply lt_IZR; lra). lia. }
      rewrite E, plus_IZR. ring.
    Qed.
    Lemma value_again n a t : Q2R start <= t -> value_of D n a (t + p) = value_of D n a t.
    Proof. intros T. unfold value_of. rewrite (folded_again t T). reflexivity. Qed.
    Lemma number_again x t : Q2R start <= t -> number W (t + p) x = number W t x.
    Proof.
      intros T. induction x; cbn [number]; rewrite ?IHx, ?IHx1, ?IHx2; try reflexivity. apply value_again, T.
    Qed.
    Lemma ahead_right lo t : is_ahead start lo = true -> Q2R start <= t -> 0 <= number W t lo.
    Proof.
      unfold is_ahead. intros H T. destruct (rigid _ lo) as [a|] eqn:E; [|discriminate].
      rewrite (rigid_right _ lo a t E); [apply le_R in H; rewrite zero_R in H; exact H|].
      split; [exact T|exact Logic.I].
    Qed.
    Lemma within_again lo hi t u : Q2R start <= t -> within W (t + p) lo hi u <-> within W t lo hi (u - p).
    Proof.
      intros T. unfold within. rewrite (number_again lo t T). destruct hi as [hi|]; [rewrite (number_again hi t T)|];
        split; intros [A B]; (split; [lra|try exact Logic.I; lra]).
    Qed.
    Notation same_later f := (forall b t, Q2R start <= t ->
      Meaning.holds W named b (t + p) f <-> Meaning.holds W named b t f).
    Lemma earlier_one b t lo hi f : is_ahead start lo = true -> Q2R start <= t -> same_later f ->
      forall u, within W (t + p) lo hi u -> Meaning.holds W named b u f <-> Meaning.holds W named b (u - p) f.
    Proof.
      intros A T S u U. apply (within_again lo hi t u T) in U as [U _]. pose proof (ahead_right lo t A T).
      rewrite <- (S b (u - p)) by lra. replace (u - p + p) with u by ring. tauto.
    Qed.
    Lemma back lo hi t u : Q2R start <= t -> within W t lo hi u -> within W (t + p) lo hi (u + p).
    Proof. intros T U. apply (within_again lo hi t (u + p) T). replace (u + p - p) with u by ring. exact U. Qed.
    Lemma again f : looks_ahead start f = true -> same_later f.
    Proof.
      induction f; cbn [looks_ahead]; intros H c t T; cbn [Meaning.holds];
        repeat match goal with H : _ && _ = true |- _ => apply andb_prop in H; destruct H end.
      - tauto.
      - assert (E : forall s, extended_number W (t + p) s = extended_number W t s)
          by (intros [x|x]; cbn [extended_number]; rewrite (number_again x t T); reflexivity).
        rewrite !E. tauto.
      - unfold occupies. cbn [Meaning.shape value measure world_of]. rewrite !(value_again _ _ t T). tauto.
      - split; intros [e [M E]]; exists e; (split; [exact M|apply IHf; assumption]).
      - split; intros E e M; apply IHf; auto.
      - rewrite (IHf H c t T). tauto.
      - rewrite (IHf1 H c t T), (IHf2 H0 c t T). tauto.
      - rewrite (IHf1 H c t T), (IHf2 H0 c t T). tauto.
      - pose proof (ahead_right lo t H T) as N. split; intros [u [U [G L]]].
        + exists (u - p). split; [apply within_again; assumption|]. split.
          * apply (earlier_one c t lo hi f2 H T (IHf2 H0) u U), G.
          * intros w K. rewrite <- (IHf1 H1 c w) by lra. apply L. rewrite (number_again lo t T). lra.
        + exists (u + p). split; [apply back; assumption|]. split.
          * rewrite (IHf2 H0 c u); [exact G|]. destruct U as [U _]. lra.
          * intros w K. rewrite (number_again lo t T) in K. replace w with (w - p + p) by ring.
            apply (IHf1 H1 c (w - p)); [lra|]. apply L. lra.
      - split; intros [u [U G]].
        + exists (u - p). split; [apply within_again; assumption|].
          apply (earlier_one c t lo hi f H T (IHf H0) u U), G.
        + exists (u + p). split; [apply back; assumption|].
          apply (IHf H0 c u); [destruct U; pose proof (ahead_right lo t H T); lra|exact G].
      - split; intros G u U.
        + apply (IHf H0 c u); [destruct U; pose proof (ahead_right lo t H T); lra|]. apply G, back; assumption.
        + apply (earlier_one c t lo hi f H T (IHf H0) u U), G, within_again; assumption.
    Qed.
    Lemma again_and_again f n : looks_ahead start f = true -> forall b t, Q2R start <= t ->
      Meaning.holds W named b (t + INR n * p) f <-> Meaning.holds W named b t f.
    Proof.
      intros H b t T. induction n as [|n IH].
      - replace (t + INR 0 * p) with t by (simpl; ring). tauto.
      - rewrite S_INR. replace (t + (INR n + 1) * p) with (t + INR n * p + p) by ring.
        rewrite (again f H b); [exact IH|]. pose proof (Rmult_le_pos _ _ (pos_INR n) (Rlt_le _ _ P)). lra.
    Qed.
    Lemma many_R n : Q2R (many n period) = INR n * p.
    Proof. unfold many. rewrite times_R. f_equal. unfold Q2R. simpl. rewrite INR_IZR_INZ. field. Qed.
    (* Which round an instant is in, counted from a. *)
    Lemma round_of a t : a <= t -> exists n, a <= t - INR n * p < a + p.
    Proof.
      intros T. exists (Z.to_nat (Int_part ((t - a) / p))). destruct (base_Int_part ((t - a) / p)) as [A B].
      set (n := Int_part _) in *.
      assert (L : 0 <= (t - a) / p) by (apply Rmult_le_pos; [lra|apply Rlt_le, Rinv_0_lt_compat, P]).
      assert (-1 < n)%Z by (apply lt_IZR; lra). rewrite INR_IZR_INZ, Z2Nat.id by lia.
      assert (E : (t - a) = (t - a) / p * p) by (field; lra). split.
      - pose proof (Rmult_le_compat_r p _ _ (Rlt_le _ _ P) A). lra.
      - assert ((t - a) / p < IZR n + 1) as C by lra. pose proof (Rmult_lt_compat_r p _ _ P C). lra.
    Qed.
  End Rounds.
  Lemma rounds_of_right f I period : rounds_of f I = Some period -> exists start,
    repeats D = Some (start, period) /\ 0 < Q2R period /\ Q2R start <= Q2R (from_ I) /\ looks_ahead start f = true.
  Proof.
    unfold rounds_of. destruct (repeats D) as [[start p]|] eqn:E; [|discriminate]. intros H.
    destruct (below 0 p && Qle_bool start (from_ I) && looks_ahead start f) eqn:C; [|discriminate].
    injection H as <-. apply andb_prop in C as [C A]. apply andb_prop in C as [C S].
    apply below_R in C. rewrite zero_R in C. apply le_R in S. exists start. repeat split; assumption.
  Qed.
  Lemma earlier_right I c t : inside I t -> inside (earlier I c) (t - Q2R c).
  Proof.
    unfold inside, earlier, moved_by. cbn [from_ after_ to_]. rewrite minus_R. intros [A B].
    split; [destruct (after_ I); lra|]. destruct (to_ I) as [[b o]|]; simpl in *; [|exact Logic.I].
    rewrite plus_R, Q2R_opp. destruct o; lra.
  Qed.

  (* --- derivations -------------------------------------------------------------------------------------- *)
  Definition somewhere_in (J : option interval) (check : interval -> bool) : bool :=
    match J with Some J => check J | None => false end.

  Fixpoint check (p : derivation) (f : formula) (env : nat -> nat) (pol : bool) (I : interval) {struct p} : bool :=
    let each := fix each (ps : list derivation) (es : list nat) (n : nat) (f : formula) {struct ps} : bool :=
      match ps, es with
      | [], [] => true
      | p :: ps, e :: es => check p f (put env n e) pol I && each ps es n f
      | _, _ => false
      end in
    match p, f with
    | Plain, Truth b => Bool.eqb b pol
    | Plain, Always lo hi _ => pol && is_empty I lo hi
    | Plain, Eventually lo hi _ | Plain, Until _ lo hi _ => negb pol && is_empty I lo hi
    | Sign cuts, Compare l o r => forallb (compare_on pol o l r) (parts I cuts)
    | Sign cuts, Occupies a l => forallb (occupies_on pol a (index_of env l)) (parts I cuts)
    | Turn p, Not f => check p f env (negb pol) I
    | Both p q, And f g => pol && check p f env pol I && check q g env pol I
    | Both p q, Or f g => negb pol && check p f env pol I && check q g env pol I
    | One second p, And f g => negb pol && check p (if second then g else f) env pol I
    | One second p, Or f g => pol && check p (if second then g else f) env pol I
    | Split c after p q, _ => check p f env pol (before_ I c after) && check q f env pol (since I c after)
    | Case s p q, _ => check p (assume I s true f) env pol I && check q (assume I s false f) env pol I
    | Element e p, Some_ n d f => pol && Nat.ltb e count && is_member env d e && check p f (put env n e) pol I
    | Element e p, Every n d f => negb pol && Nat.ltb e count && is_member env d e && check p f (put env n e) pol I
    | Each ps, Every n d f => pol && each ps (members env d) n f
    | Each ps, Some_ n d f => negb pol && each ps (members env d) n f
    | Whole p, Always lo hi f => pol && somewhere_in (widened I lo hi) (check p f env pol)
    | Whole p, Eventually lo hi f => negb pol && somewhere_in (widened I lo hi) (check p f env pol)
    | Whole p, Until _ lo hi g => negb pol && somewhere_in (widened I lo hi) (check p g env pol)
    | Moment m p, Eventually lo hi f => pol && meets I m lo hi && check p f env pol (image I m)
    | Moment m p, Always lo hi f => negb pol && meets I m lo hi && check p f env pol (image I m)
    | Reach m p q, Until f lo hi g =>
        pol && meets I m lo hi && check q g env pol (image I m)
        && (at_once I m lo || somewhere_in (until_then I m lo true) (check p f env pol))
    | Break m p q, Until f lo hi g =>
        negb pol && is_late I m lo && check p f env pol (image I m)
        && somewhere_in (until_then I m lo false) (check q g env pol)
    | Soon c d p q, Until f lo hi g =>
        negb pol && below c d && is_late I (Fixed c) lo
        && somewhere_in (until_then I (Fixed c) lo false) (check p g env pol) && check q f env pol (open_ c d)
    | Crossing a b s p q r, Eventually lo hi f =>
        pol && falls s a b && is_late I (Fixed a) lo && is_early I (Fixed b) hi
        && check r (at_zero (closed_ a b) s f) env pol (closed_ a b)
    | Crossing a b s p q r, Always lo hi f =>
        negb pol && falls s a b && is_late I (Fixed a) lo && is_early I (Fixed b) hi
        && check r (at_zero (closed_ a b) s f) env pol (closed_ a b)
    | Crossing a b s p q r, Until f lo hi g =>
        is_late I (Fixed a) lo
        && somewhere_in (until_then I (Fixed a) lo false) (check p (if pol then f else g) env pol)
        && (if pol
            then falls s a b && is_early I (Fixed b) hi && check q (assume (closed_ a b) s true f) env pol (closed_ a b)
                 && check r (at_zero (closed_ a b) s g) env pol (closed_ a b)
            else below a b && above true s (closed_ b b) && check q (assume (closed_ a b) s false g) env pol (closed_ a b)
                 && check r (assume (closed_ a b) s true f) env pol (closed_ a b))
    | Earlier n p, _ =>
        match repeats D with
        | Some (_, period) =>
            let J := earlier I (many n period) in
            match rounds_of f J with Some _ => check p f env pol J | None => false end
        | None => false
        end
    | Round p, _ =>
        match rounds_of f I with Some period => check p f env pol (first_of_rounds I period) | None => false end
    | _, _ => false
    end.

  Notation holds := (holds W named).
  Definition right_for (p : derivation) : Prop := forall f env pol I b t,
    check p f env pol I = true -> fits b env -> inside I t -> says pol (holds b t f).

  Lemma number_exists e : Nat.ltb e count = true -> exists x : element W, number_of x = e.
  Proof. intros H. exists (exist _ e H). reflexivity. Qed.
  Lemma somewhere_exists J g : somewhere_in J g = true -> exists I, J = Some I /\ g I = true.
  Proof. destruct J as [I|]; [|discriminate]. intros H. exists I. split; [reflexivity|exact H]. Qed.
  Lemma each_right ps : Forall right_for ps -> forall es n f env pol I b t,
    (fix each (ps : list derivation) (es : list nat) (n : nat) (f : formula) {struct ps} : bool :=
      match ps, es with
      | [], [] => true
      | p :: ps, e :: es => check p f (put env n e) pol I && each ps es n f
      | _, _ => false
      end) ps es n f = true -> fits b env -> inside I t ->
    forall e, In (number_of e) es -> says pol (holds (bind W b n e) t f).
  Proof.
    induction 1 as [|p ps P _ IH]; intros [|x es] n f env pol I b t H B T e E; try discriminate; [destruct E|].
    apply andb_prop in H as [H1 H2]. destruct E as [->|E].
    - apply (P _ _ _ _ _ _ H1); [apply put_right, B|exact T].
    - apply (IH _ _ _ _ _ _ _ _ H2 B T e E).
  Qed.
  Lemma derivation_ind' (P : derivation -> Prop) :
    P Plain -> (forall cuts, P (Sign cuts)) -> (forall p, P p -> P (Turn p)) ->
    (forall p q, P p -> P q -> P (Both p q)) -> (forall s p, P p -> P (One s p)) ->
    (forall c a p q, P p -> P q -> P (Split c a p q)) ->
    (forall s p q, P p -> P q -> P (Case s p q)) -> (forall e p, P p -> P (Element e p)) ->
    (forall ps, Forall P ps -> P (Each ps)) -> (forall p, P p -> P (Whole p)) ->
    (forall m p, P p -> P (Moment m p)) -> (forall m p q, P p -> P q -> P (Reach m p q)) ->
    (forall m p q, P p -> P q -> P (Break m p q)) ->
    (forall c d p q, P p -> P q -> P (Soon c d p q)) ->
    (forall a b s p q r, P p -> P q -> P r -> P (Crossing a b s p q r)) -> (forall n p, P p -> P (Earlier n p)) ->
    (forall p, P p -> P (Round p)) -> forall p, P p.
  Proof.
    intros H1 H2 H3 H4 H5 H6 HC H7 H8 H9 H10 H11 H12 HS HZ HE HR. fix IH 1. intros p.
    destruct p; [apply H1|apply H2|apply H3|apply H4|apply H5|apply H6|apply HC|apply H7|apply H8|apply H9|apply H10|apply H11|apply H12
              |apply HS|apply HZ|apply HE|apply HR];
      try apply IH.
    induction ps as [|p ps IHps]; constructor; [apply IH|exact IHps].
  Qed.

  Ltac parted H :=
    repeat match type of H with _ && _ = true => let X := fresh "X" in apply andb_prop in H as [H X] end.

  Theorem check_right p : right_for p.
  Proof.
    induction p as [|cuts|p IHp|p q IHp IHq|second p IHp|c after p q IHp IHq|s p q IHp IHq|e p IHp|ps IHps|p IHp|m p IHp
                   |m p q IHp IHq|m p q IHp IHq|c d p q IHp IHq|za zb s p q r IHp IHq IHr|n p IHp|p IHp] using derivation_ind';
      intros f env pol I b t H B T; cbn [check] in H.
    - destruct f; try discriminate; [apply Bool.eqb_prop in H; subst; simpl; destruct pol; simpl; congruence| | |];
        apply andb_prop in H as [H0 H]; destruct pol; try discriminate; cbn [Meaning.holds says].
      + intros [u [U _]]. exact (is_empty_right I lo hi t u H T U).
      + intros [u [U _]]. exact (is_empty_right I lo hi t u H T U).
      + intros u U. destruct (is_empty_right I lo hi t u H T U).
    - destruct f; try discriminate; rewrite forallb_forall in H; destruct (parts_right cuts t I T) as [J [P J']];
        specialize (H J P); cbn [Meaning.holds].
      + apply (compare_right _ _ _ _ _ _ H J').
      + rewrite <- (index_right b env l B) in H. apply (occupies_right _ _ _ _ _ H J').
    - destruct f; try discriminate. specialize (IHp _ _ _ _ _ _ H B T). cbn [Meaning.holds].
      destruct pol; simpl in *; tauto.
    - destruct f; try discriminate; apply andb_prop in H as [H H2]; apply andb_prop in H as [H0 H1];
        destruct pol; try discriminate;
        specialize (IHp _ _ _ _ _ _ H1 B T); specialize (IHq _ _ _ _ _ _ H2 B T); simpl in *; tauto.
    - destruct f; try discriminate; apply andb_prop in H as [H0 H1]; destruct pol; try discriminate;
        specialize (IHp _ _ _ _ _ _ H1 B T); destruct second; simpl in *; tauto.
    - apply andb_prop in H as [H1 H2]. destruct (split_right I c after t T) as [S|S];
        [apply (IHp _ _ _ _ _ _ H1 B S)|apply (IHq _ _ _ _ _ _ H2 B S)].
    - apply andb_prop in H as [H1 H2]. destruct (Rlt_le_dec 0 (eval s t)) as [S|S].
      + specialize (IHp _ _ _ _ _ _ H1 B T). pose proof (assume_right I s true f t T S b) as E.
        destruct pol; simpl in *; tauto.
      + specialize (IHq _ _ _ _ _ _ H2 B T). pose proof (assume_right I s false f t T S b) as E.
        destruct pol; simpl in *; tauto.
    - destruct f; try discriminate; apply andb_prop in H as [H H1]; apply andb_prop in H as [H M];
        apply andb_prop in H as [H0 L]; destruct pol; try discriminate;
        destruct (number_exists e L) as [x X]; rewrite <- X in *; apply (is_member_right b env d x B) in M;
        specialize (IHp _ _ _ _ _ _ H1 (put_right b env n x B) T); cbn [Meaning.holds says] in *.
      + exists x. split; assumption.
      + intros N. apply IHp, N, M.
    - destruct f; try discriminate; apply andb_prop in H as [H0 H1]; destruct pol; try discriminate;
        pose proof (each_right ps IHps _ _ _ _ _ _ _ _ H1 B T) as E; cbn [Meaning.holds says] in *.
      + intros [x [M N]]. apply (E x); [apply (members_right b env d x B), M|exact N].
      + intros x M. apply (E x), (members_right b env d x B), M.
    - destruct f; try discriminate; apply andb_prop in H as [H0 H1]; destruct pol; try discriminate;
        apply somewhere_exists in H1 as [J [EJ H1]]; cbn [Meaning.holds says] in *.
      + intros [u [U [N _]]]. apply (IHp _ _ _ _ _ _ H1 B (widened_right I lo hi J t u EJ T U) N).
      + intros [u [U N]]. apply (IHp _ _ _ _ _ _ H1 B (widened_right I lo hi J t u EJ T U) N).
      + intros u U. apply (IHp _ _ _ _ _ _ H1 B (widened_right I lo hi J t u EJ T U)).
    - destruct f; try discriminate; apply andb_prop in H as [H H1]; apply andb_prop in H as [H0 M];
        destruct pol; try discriminate; pose proof (meets_right I m lo hi t M T) as U;
        specialize (IHp _ _ _ _ _ _ H1 B (image_right I m t T)); cbn [Meaning.holds says] in *.
      + exists (at_ m t). split; assumption.
      + intros N. apply IHp, N, U.
    - destruct f; try discriminate; apply andb_prop in H as [H H2]; apply andb_prop in H as [H H1];
        apply andb_prop in H as [H0 M]; destruct pol; try discriminate; pose proof (meets_right I m lo hi t M T) as U;
        specialize (IHq _ _ _ _ _ _ H1 B (image_right I m t T)); cbn [Meaning.holds says] in *.
      exists (at_ m t). split; [exact U|split; [exact IHq|]]. intros w [A L].
      apply orb_prop in H2 as [O|H2].
      + pose proof (at_once_right I m lo t O T). exfalso. lra.
      + apply somewhere_exists in H2 as [J [EJ H2]].
        apply (IHp _ _ _ _ _ _ H2 B (until_then_right I m lo true J t w EJ T A L)).
    - destruct f; try discriminate; apply andb_prop in H as [H H2]; apply andb_prop in H as [H H1];
        apply andb_prop in H as [H0 M]; destruct pol; try discriminate; pose proof (is_late_right I m lo t M T) as U;
        specialize (IHp _ _ _ _ _ _ H1 B (image_right I m t T)); cbn [Meaning.holds says] in *.
      intros [u [[A _] [G L]]]. apply somewhere_exists in H2 as [J [EJ H2]].
      destruct (Rle_lt_dec u (at_ m t)) as [C|C].
      + apply (IHq _ _ _ _ _ _ H2 B (until_then_right I m lo false J t u EJ T A C) G).
      + apply IHp, L. lra.
    - destruct f; try discriminate; parted H; destruct pol; try discriminate.
      apply below_R in X2. pose proof (is_late_right I (Fixed c) lo t X1 T) as L. cbn [at_] in L.
      cbn [Meaning.holds says] in *. intros [u [[A _] [G K]]]. destruct (Rle_lt_dec u (Q2R c)) as [C|C].
      + apply somewhere_exists in X0 as [J [EJ X0]].
        apply (IHp _ _ _ _ _ _ X0 B (until_then_right I (Fixed c) lo false J t u EJ T A C) G).
      + set (w := (Q2R c + Rmin u (Q2R d)) / 2). pose proof (Rmin_l u (Q2R d)). pose proof (Rmin_r u (Q2R d)).
        assert (Q2R c < Rmin u (Q2R d)) by (apply Rmin_glb_lt; assumption).
        assert (V : inside (open_ c d) w) by (unfold inside, open_, w; cbn [from_ after_ to_]; lra).
        apply (IHq _ _ _ _ _ _ X B V), K. unfold w. lra.
    - destruct f; try discriminate; parted H.
      + pose proof (is_late_right I (Fixed za) lo t H T) as L. cbn [at_] in L.
        apply somewhere_exists in X0 as [J [EJ X0]]. destruct pol; parted X.
        * destruct (falls_right s za zb X) as [z [Z1 [Z2 Z3]]].
          pose proof (is_early_right I (Fixed zb) hi t X3 T) as E. cbn [at_] in E.
          assert (V : inside (closed_ za zb) z) by (apply closed_right; lra).
          specialize (IHr _ _ _ _ _ _ X1 B V). cbn [Meaning.holds says] in *.
          apply (at_zero_right (closed_ za zb) s f2 z V Z2) in IHr.
          exists z. split; [split; [lra|destruct hi; lra]|]. split; [exact IHr|]. intros w [A K].
          destruct (Rle_lt_dec w (Q2R za)) as [C|C].
          -- apply (IHp _ _ _ _ _ _ X0 B (until_then_right I (Fixed za) lo false J t w EJ T A C)).
          -- assert (V' : inside (closed_ za zb) w) by (apply closed_right; lra).
             apply (assume_right (closed_ za zb) s true f1 w V'); [apply Z3; lra|].
             apply (IHq _ _ _ _ _ _ X2 B V').
        * apply below_R in X. cbn [Meaning.holds says] in *. intros [u [[A _] [G K]]].
          assert (N : 0 < eval s (Q2R zb))
            by (apply (above_right true s (closed_ zb zb)); [exact X3|apply closed_right; lra]).
          assert (F' : forall w, Q2R za <= w <= Q2R zb -> 0 < eval s w -> ~ holds b w f1).
          { intros w V S H'. apply (IHr _ _ _ _ _ _ X1 B (closed_right za zb w V)).
            apply (assume_right (closed_ za zb) s true f1 w (closed_right za zb w V)); assumption. }
          destruct (Rle_lt_dec u (Q2R za)) as [C|C];
            [apply (IHp _ _ _ _ _ _ X0 B (until_then_right I (Fixed za) lo false J t u EJ T A C) G)|].
          destruct (Rle_lt_dec u (Q2R zb)) as [C'|C']; [|apply (F' (Q2R zb)); [lra|exact N|apply K; lra]].
          assert (V : Q2R za <= u <= Q2R zb) by lra.
          apply (IHq _ _ _ _ _ _ X2 B (closed_right za zb u V)).
          apply (assume_right (closed_ za zb) s false f2 u (closed_right za zb u V)); [|exact G].
          apply (at_the_end s (Q2R za)); [exact C|]. intros w M.
          destruct (Rle_lt_dec (eval s w) 0) as [O|O]; [exact O|exfalso]. apply (F' w); [lra|exact O|apply K; lra].
      + destruct pol; try discriminate. destruct (falls_right s za zb X2) as [z [Z1 [Z2 _]]].
        pose proof (is_late_right I (Fixed za) lo t X1 T) as L. pose proof (is_early_right I (Fixed zb) hi t X0 T) as E.
        cbn [at_] in L, E. assert (V : inside (closed_ za zb) z) by (apply closed_right; lra).
        specialize (IHr _ _ _ _ _ _ X B V). cbn [Meaning.holds says] in *.
        apply (at_zero_right (closed_ za zb) s f z V Z2) in IHr.
        exists z. split; [split; [lra|destruct hi; lra]|exact IHr].
      + destruct pol; try discriminate. destruct (falls_right s za zb X2) as [z [Z1 [Z2 _]]].
        pose proof (is_late_right I (Fixed za) lo t X1 T) as L. pose proof (is_early_right I (Fixed zb) hi t X0 T) as E.
        cbn [at_] in L, E. assert (V : inside (closed_ za zb) z) by (apply closed_right; lra).
        specialize (IHr _ _ _ _ _ _ X B V). cbn [Meaning.holds says] in *.
        intros N. apply IHr, (at_zero_right (closed_ za zb) s f z V Z2), N. split; [lra|destruct hi; lra].
    - destruct (repeats D) as [[start period]|] eqn:E; [|discriminate].
      destruct (rounds_of f (earlier I (many n period))) as [q|] eqn:R; [|discriminate].
      apply rounds_of_right in R as [s [R [P [S A]]]]. rewrite E in R. injection R as <- <-.
      pose proof (earlier_right I (many n period) t T) as T'. specialize (IHp _ _ _ _ _ _ H B T').
      rewrite many_R in *. pose proof (inside_from _ _ T') as F'.
      pose proof (again_and_again start period E P f n A b (t - INR n * Q2R period)) as G.
      replace (t - INR n * Q2R period + INR n * Q2R period) with t in G by ring.
      destruct pol; simpl in *; apply G || (intros N; apply IHp, G); try assumption; lra.
    - destruct (rounds_of f I) as [period|] eqn:R; [|discriminate].
      apply rounds_of_right in R as [start [E [P [S A]]]]. pose proof (inside_from _ _ T) as F'.
      destruct (round_of period P (Q2R (from_ I)) t F') as [n [N1 N2]].
      assert (T' : inside (first_of_rounds I period) (t - INR n * Q2R period))
        by (unfold inside, first_of_rounds; cbn [from_ after_ to_]; rewrite plus_R; lra).
      specialize (IHp _ _ _ _ _ _ H B T').
      pose proof (again_and_again start period E P f n A b (t - INR n * Q2R period)) as G.
      replace (t - INR n * Q2R period + INR n * Q2R period) with t in G by ring.
      destruct pol; simpl in *; apply G || (intros N; apply IHp, G); try assumption; lra.
  Qed.
End Check.

(* --- the theorem ---------------------------------------------------------------------------------------- *)
Definition all_steps (ok : Q -> bool) (steps : option (list (Q * Q * Q))) : bool :=
  match steps with
  | Some l => ok (first_step l) && forallb (fun e => ok (snd (fst e)) && ok (snd e)) l
  | None => ok 0%Q
  end.
Definition within_bound (D : drive) (b : bound) : bool :=
  match b with
  | at_least_0 p => Qle_bool 0 (look_up p (values D) 0%Q)
  | above_0 p => below 0 (look_up p (values D) 0%Q)
  | own_at_least n a low => all_steps (Qle_bool low) (steps_of D (Own n) a)
  | own_at_most n a high => all_steps (fun x => Qle_bool x high) (steps_of D (Own n) a)
  end.
Lemma stepped_within (ok : Q -> bool) steps t : forall before, ok before = true ->
  forallb (fun e => ok (snd (fst e)) && ok (snd e)) steps = true -> ok (stepped before steps t) = true.
Proof.
  induction steps as [|[[k x] y] steps IH]; intros before B H; cbn [stepped]; [exact B|].
  apply andb_prop in H as [X H]. apply andb_prop in X as [X Y]. cbn [fst snd] in X, Y.
  destruct (Rlt_dec t (Q2R k)); [exact B|]. destruct (Req_EM_T t (Q2R k)); [exact X|apply IH; assumption].
Qed.
Lemma own_within D (ok : Q -> bool) n a t : all_steps ok (steps_of D (Own n) a) = true ->
  exists x, value_of D (Own n) a t = Q2R x /\ ok x = true.
Proof.
  unfold all_steps, value_of. destruct (steps_of D (Own n) a) as [l|]; intros H.
  - apply andb_prop in H as [H1 H2]. eexists. split; [reflexivity|]. apply stepped_within; assumption.
  - exists 0%Q. split; [symmetry; apply zero_R|exact H].
Qed.
Definition now : interval := {| from_ := 0; after_ := false; to_ := Some (0%Q, false) |}.
Definition accepts (D : drive) (bounds : list bound) (claim : formula) (p : derivation) : bool :=
  forallb (within_bound D) bounds && check D (fleet_of D) p claim (fun _ => 0%nat) true now.

Theorem shown D bounds claim p : accepts D bounds claim p = true -> shows D bounds claim.
Proof.
  unfold accepts, shows. intros H. apply andb_prop in H as [R H]. split.
  - unfold respects. apply Forall_forall. intros b B. rewrite forallb_forall in R. specialize (R b B).
    destruct b as [x|x|n a low|n a high]; cbn [within_bound keeps_to] in *.
    + apply le_R in R. rewrite zero_R in R. exact R.
    + apply below_R in R. rewrite zero_R in R. exact R.
    + intros t. destruct (own_within D _ n a t R) as [x [E L]]. cbn [value world_of]. rewrite E. apply le_R, L.
    + intros t. destruct (own_within D _ n a t R) as [x [E L]]. cbn [value world_of]. rewrite E. apply le_R, L.
  - apply (check_right D (fleet_of D) eq_refl p claim (fun _ => 0%nat) true now (unbound (world_of D)) 0 H).
    + intros k. reflexivity.
    + unfold inside, now. cbn [from_ after_ to_]. rewrite zero_R. lra.
Qed.

(* So the claim can hold, and its opposite does not always. *)
Corollary not_always D bounds claim : shows D bounds claim -> ~ valid bounds (Not claim).
Proof. intros [R H] V. exact (V (world_of D) (element_named D) R H). Qed.
(* And a claim whose opposite is true of a trace does not always hold. *)
Theorem refuted D bounds claim p : accepts D bounds (Not claim) p = true -> ~ valid bounds claim.
Proof. intros H V. destruct (shown D bounds (Not claim) p H) as [R N]. exact (N (V (world_of D) (element_named D) R)). Qed.
