(* A checker of closed tableaux, and the proof that it is right.  NOT TRUSTED: proved.

   A tableau shows that a claim cannot be false: it starts from "the claim is false at time 0" and takes facts
   apart until each branch is absurd.  `accepts` is a program that checks a tableau, and the theorem
   `accepted` at the end says: what it accepts is valid, in the sense of Meaning.v.  Tableaux are found by
   roadproof; nothing here relies on how. *)
From Coq Require Import Reals QArith Qreals String List Bool Arith Lia Lra Classical.
From Roadproof Require Import Meaning Linear.
Import ListNotations.
Open Scope R_scope.

(* --- formulas: equality, instances of quantifiers over the road, what time cannot change --------------- *)
Lemma Q_dec (p q : Q) : {p = q} + {p <> q}.
Proof. decide equality; [apply Pos.eq_dec|apply Z.eq_dec]. Defined.
Lemma signal_dec (x y : signal) : {x = y} + {x <> y}.
Proof. decide equality; apply string_dec. Defined.
Lemma term_dec (x y : term) : {x = y} + {x <> y}.
Proof. decide equality; solve [apply string_dec|apply Q_dec|apply Nat.eq_dec|apply signal_dec|decide equality]. Defined.
Lemma side_dec (x y : side) : {x = y} + {x <> y}.
Proof. decide equality; apply term_dec. Defined.
Lemma road_dec (x y : road) : {x = y} + {x <> y}.
Proof. decide equality; solve [apply string_dec|apply Nat.eq_dec]. Defined.
Lemma zone_dec (x y : zone) : {x = y} + {x <> y}.
Proof. decide equality. Defined.
Lemma domain_dec (x y : domain) : {x = y} + {x <> y}.
Proof. decide equality; solve [apply zone_dec|apply road_dec]. Defined.
Lemma option_dec (x y : option term) : {x = y} + {x <> y}.
Proof. decide equality; apply term_dec. Defined.
Lemma formula_dec (x y : formula) : {x = y} + {x <> y}.
Proof.
  decide equality;
    solve [apply string_dec|apply road_dec|apply domain_dec|apply side_dec|apply term_dec|apply option_dec
          |apply bool_dec|apply Nat.eq_dec|decide equality].
Defined.
Definition same (x y : formula) : bool := if formula_dec x y then true else false.
Lemma same_eq x y : same x y = true -> x = y.
Proof. unfold same. destruct (formula_dec x y); [auto|discriminate]. Qed.

(* what quantifier number k speaks of becomes the element called c *)
Definition road_inst (k : nat) (c : string) (l : road) : road :=
  match l with Bound n => if Nat.eqb n k then Free c else Bound n | Free x => Free x end.
Definition domain_inst k c d :=
  match d with
  | Adjacent l => Adjacent (road_inst k c l) | Lanelets l => Lanelets (road_inst k c l) | _ => d
  end.
Fixpoint inst (k : nat) (c : string) (f : formula) : formula :=
  match f with
  | Truth _ | Compare _ _ _ => f
  | Occupies a l => Occupies a (road_inst k c l)
  | Some_ n d f => Some_ n (domain_inst k c d) (if Nat.eqb n k then f else inst k c f)
  | Every n d f => Every n (domain_inst k c d) (if Nat.eqb n k then f else inst k c f)
  | Not f => Not (inst k c f)
  | And f g => And (inst k c f) (inst k c g)
  | Or f g => Or (inst k c f) (inst k c g)
  | Until f lo hi g => Until (inst k c f) lo hi (inst k c g)
  | Eventually lo hi f => Eventually lo hi (inst k c f)
  | Always lo hi f => Always lo hi (inst k c f)
  end.
Definition in_road (c : string) (l : road) := match l with Free x => String.eqb x c | Bound _ => false end.
Definition in_domain c d := match d with Adjacent l | Lanelets l => in_road c l | _ => false end.
Fixpoint occurs (c : string) (f : formula) : bool :=
  match f with
  | Truth _ | Compare _ _ _ => false
  | Occupies _ l => in_road c l
  | Some_ _ d f | Every _ d f => in_domain c d || occurs c f
  | Not f | Eventually _ _ f | Always _ _ f => occurs c f
  | And f g | Or f g | Until f _ _ g => occurs c f || occurs c g
  end.
Fixpoint term_rigid (x : term) : bool :=
  match x with
  | Num _ | Par _ | Var _ | Siz _ _ => true
  | Sig _ _ => false
  | Add x y | Mul x y | Div x y | Max x y | Min x y => term_rigid x && term_rigid y
  | Pow x _ => term_rigid x
  end.
Definition side_rigid s := match s with Fin x | Inv x => term_rigid x end.
Fixpoint rigid (f : formula) : bool :=
  match f with
  | Truth _ => true
  | Compare l _ r => side_rigid l && side_rigid r
  | Not f => rigid f
  | And f g | Or f g => rigid f && rigid g
  | _ => false
  end.

Section Formulas.
  Variable W : world.
  Notation holds := (holds W).
  Notation member := (member W).
  Definition rename (named : string -> element W) c e x := if String.eqb x c then e else named x.

  Lemma number_rigid x t t' : term_rigid x = true -> number W t x = number W t' x.
  Proof.
    induction x; simpl; intros H; try reflexivity; try discriminate;
      try (apply andb_prop in H as [H1 H2]; rewrite IHx1, IHx2 by assumption; reflexivity).
    rewrite IHx by assumption; reflexivity.
  Qed.
  Lemma holds_rigid f named b t t' : rigid f = true -> holds named b t f <-> holds named b t' f.
  Proof.
    induction f; simpl; intros H; try discriminate; try tauto.
    - apply andb_prop in H as [H1 H2].
      assert (E : forall s, side_rigid s = true -> extended_number W t s = extended_number W t' s).
      { intros [x|x] Hx; simpl in *; rewrite (number_rigid x t t' Hx); reflexivity. }
      rewrite (E l), (E r) by assumption. reflexivity.
    - apply andb_prop in H as [H1 H2]. rewrite IHf1, IHf2 by assumption. reflexivity.
    - apply andb_prop in H as [H1 H2]. rewrite IHf1, IHf2 by assumption. reflexivity.
  Qed.

  Lemma bind_same b n e e' k : bind W (bind W b n e) n e' k = bind W b n e' k.
  Proof. unfold bind. destruct (Nat.eqb k n); reflexivity. Qed.
  Lemma bind_swap b n m e e' k : n <> m -> bind W (bind W b n e) m e' k = bind W (bind W b m e') n e k.
  Proof.
    unfold bind. intros N. destruct (Nat.eqb_spec k n), (Nat.eqb_spec k m); congruence.
  Qed.
  Lemma member_ext named b b' d e : (forall k, b k = b' k) -> member named b d e <-> member named b' d e.
  Proof. intros E. destruct d as [|[x|n]|[x|n]|z]; simpl; rewrite ?E; reflexivity. Qed.
  Lemma holds_ext f : forall named b b' t, (forall k, b k = b' k) -> holds named b t f <-> holds named b' t f.
  Proof.
    assert (B : forall b b' n e, (forall k, b k = b' k) -> forall k, bind W b n e k = bind W b' n e k).
    { intros b b' n e E k. unfold bind. destruct (Nat.eqb k n); auto. }
    induction f; intros named p p' t E; simpl; try tauto.
    - destruct l; simpl; rewrite ?E; reflexivity.
    - split; intros [e [H1 H2]]; exists e; (split; [apply (member_ext named p p' d e E), H1|
        apply (IHf _ _ _ t (B _ _ n e E)), H2]).
    - split; intros H e He; apply (IHf _ _ _ t (B _ _ n e E)), H, (member_ext named p p' d e E), He.
    - rewrite (IHf _ _ _ t E). reflexivity.
    - rewrite (IHf1 _ _ _ t E), (IHf2 _ _ _ t E). reflexivity.
    - rewrite (IHf1 _ _ _ t E), (IHf2 _ _ _ t E). reflexivity.
    - split; intros [u [H1 [H2 H3]]]; exists u; (split; [exact H1|split; [apply (IHf2 _ _ _ u E), H2|]]);
        intros w Hw; apply (IHf1 _ _ _ w E); auto.
    - split; intros [u [H1 H2]]; exists u; (split; [exact H1|apply (IHf _ _ _ u E), H2]).
    - split; intros H u Hu; apply (IHf _ _ _ u E); auto.
  Qed.

  Lemma place_inst named c k b l : place W named b (road_inst k c l) = place W named (bind W b k (named c)) l.
  Proof. destruct l as [x|n]; simpl; [reflexivity|]. unfold bind. destruct (Nat.eqb n k); reflexivity. Qed.
  Lemma member_inst named c k b d e :
    member named b (domain_inst k c d) e <-> member named (bind W b k (named c)) d e.
  Proof. destruct d; simpl; rewrite ?place_inst; reflexivity. Qed.
  Lemma holds_inst named c k f : forall b t,
    holds named b t (inst k c f) <-> holds named (bind W b k (named c)) t f.
  Proof.
    assert (Q : forall n f, (forall b t, holds named b t (inst k c f) <-> holds named (bind W b k (named c)) t f) ->
      forall b t e, holds named (bind W b n e) t (if Nat.eqb n k then f else inst k c f) <->
        holds named (bind W (bind W b k (named c)) n e) t f).
    { intros n g IH b t e. destruct (Nat.eqb_spec n k) as [->|N].
      - apply holds_ext. intros j. symmetry. apply bind_same.
      - rewrite IH. apply holds_ext. intros j. apply bind_swap. assumption. }
    induction f; intros p t; cbn [inst Meaning.holds]; try tauto.
    - rewrite place_inst. reflexivity.
    - split; intros [e [H1 H2]]; exists e; (split; [apply (member_inst named c k p d), H1|]).
      + apply (Q n f IHf), H2.
      + apply (Q n f IHf) in H2. exact H2.
    - split; intros H e He.
      + apply (Q n f IHf), H, (member_inst named c k p d), He.
      + apply (Q n f IHf), H, (member_inst named c k p d), He.
    - rewrite IHf. reflexivity.
    - rewrite IHf1, IHf2. reflexivity.
    - rewrite IHf1, IHf2. reflexivity.
    - split; intros [u [H1 [H2 H3]]]; exists u; (split; [exact H1|split; [apply IHf2; assumption|]]);
        intros w Hw; apply IHf1; auto.
    - split; intros [u [H1 H2]]; exists u; (split; [exact H1|apply IHf; assumption]).
    - split; intros H u Hu; apply IHf; auto.
  Qed.

  Lemma place_fresh named c e b l : in_road c l = false -> place W (rename named c e) b l = place W named b l.
  Proof. destruct l as [x|n]; simpl; [|reflexivity]. unfold rename. intros ->. reflexivity. Qed.
  Lemma member_fresh named c e b d x :
    in_domain c d = false -> member (rename named c e) b d x <-> member named b d x.
  Proof. destruct d; simpl; intros H; rewrite ?(place_fresh _ _ _ _ _ H); reflexivity. Qed.
  Lemma holds_fresh f named c e : occurs c f = false ->
    forall b t, holds (rename named c e) b t f <-> holds named b t f.
  Proof.
    induction f; simpl; intros H p t; try tauto;
      try (apply orb_false_iff in H as [H1 H2]).
    - rewrite place_fresh by assumption. reflexivity.
    - split; intros [x [A B]]; exists x; (split; [apply (member_fresh named c e p d x H1); assumption|
        apply IHf; assumption]).
    - split; intros A x B; apply IHf; try assumption; apply A; apply (member_fresh named c e p d x H1); assumption.
    - rewrite IHf by assumption. reflexivity.
    - rewrite IHf1, IHf2 by assumption. reflexivity.
    - rewrite IHf1, IHf2 by assumption. reflexivity.
    - split; intros [u [A [B D]]]; exists u; repeat split; try apply A; try (apply IHf2; assumption);
        intros w Hw; apply IHf1; auto.
    - split; intros [u [A B]]; exists u; split; try assumption; apply IHf; assumption.
    - split; intros A u Hu; apply IHf; auto.
  Qed.
End Formulas.

(* --- tableaux ------------------------------------------------------------------------------------------ *)
(* Moments are linear expressions (Linear.v) over 1, the parameters, and times that are named as they come:
   moment number n is called by its number.  Facts and constraints are numbered from 0 in each branch. *)
Inductive fact :=
| At (b : bool) (m : vec) (f : formula)                    (* f is true (false) at m *)
| Throughout (lo hi : vec) (f : formula)                   (* f is true from lo on and before hi *)
| Belongs (b : bool) (d : domain) (c : string).            (* the element called c is (not) in d *)
Inductive tree :=
| CloseTruth (i : nat)                                     (* true is false, or false is true *)
| Close (i j : nat) (w1 w2 : wit)                          (* f is true and false at one moment *)
| CloseLinear (w : wit)                                    (* constraints on moments are absurd *)
| CloseRoad (i : nat)                                      (* no road has such an element *)
| CloseRoads (i j : nat)                                   (* in d and not; beside it one way only; in two zones *)
| CloseZones (i j k : nat)                                 (* in none of the three zones *)
| Alpha (i : nat) (t : tree)                               (* not; both of a conjunction *)
| Beta (i : nat) (t1 t2 : tree)                            (* one of a disjunction *)
| Timing (i : nat) (t : tree)                              (* a comparison of parameters as a constraint *)
| New (i n : nat) (t : tree)                               (* a name for a moment that exists *)
| Inst (i : nat) (m : vec) (w1 w2 : wit) (t : tree)        (* what holds throughout, at m *)
| InstUntil (i : nat) (m : vec) (w1 w2 : wit) (n : nat) (t1 t2 : tree)  (* not f U g: g fails at m, or f before *)
| NewRoad (i : nat) (c : string) (t : tree)                (* a name for an element that exists *)
| InstRoad (i : nat) (c : string) (t1 t2 : tree)           (* what holds of all in a domain, of c if it is in it *)
| Cut (v : vec) (t1 t2 : tree)                             (* 0 <= v, or not *)
| Fact (k : nat) (m : vec) (t : tree).                     (* a fact about one instant, at m *)

Fixpoint index (p : string) (ps : list string) : option nat :=
  match ps with [] => None | q :: ps => if String.eqb q p then Some O else option_map S (index p ps) end.

Section Check.
  Variable ps : list string.                               (* the parameters that moments speak of *)
  Variable facts : list formula.

  Fixpoint linear (x : term) : option vec :=
    match x with
    | Num q => Some [q]
    | Par p => option_map (fun i => unit (S i)) (index p ps)
    | Add x y => match linear x, linear y with Some u, Some v => Some (vadd u v) | _, _ => None end
    | Mul x y =>
        match linear x, linear y with
        | Some [q], Some v => Some (vscale q v) | Some v, Some [q] => Some (vscale q v) | _, _ => None
        end
    | Div x y =>
        match linear x, linear y with
        | Some v, Some [q] => if Qeq_bool q 0 then None else Some (vscale (/ q) v) | _, _ => None
        end
    | _ => None
    end.
  (* m + lo, and m + hi where there is one *)
  Definition window (m : vec) (lo : term) (hi : option term) : option (vec * option vec) :=
    match linear lo, hi with
    | Some a, None => Some (vadd m a, None)
    | Some a, Some b => option_map (fun b => (vadd m a, Some (vadd m b))) (linear b)
    | None, _ => None
    end.
  Definition window_cons (n : nat) (w : vec * option vec) (C : list con) : list con :=
    let C1 := (false, vsub (unit n) (fst w)) :: C in
    match snd w with None => C1 | Some b => (false, vsub b (unit n)) :: C1 end.
  Definition inside (C : list con) (m : vec) (w : vec * option vec) (w1 w2 : wit) : bool :=
    entails C (vsub m (fst w)) w1 && match snd w with None => true | Some b => entails C (vsub b m) w2 end.
  Definition fits (n : nat) (w : vec * option vec) : bool :=
    Nat.leb (length (fst w)) n && match snd w with None => true | Some b => Nat.leb (length b) n end.

  Definition dimension (f : fact) : nat :=
    match f with At _ m _ => length m | Throughout lo hi _ => Nat.max (length lo) (length hi) | Belongs _ _ _ => 0 end.
  Definition fresh (n : nat) (G : list fact) (C : list con) : bool :=
    Nat.ltb (length ps) n && forallb (fun f => Nat.leb (dimension f) n) G
    && forallb (fun c : con => Nat.leb (length (snd c)) n) C.
  Definition fact_occurs (c : string) (f : fact) : bool :=
    match f with
    | At _ _ f | Throughout _ _ f => occurs c f
    | Belongs _ d x => in_domain c d || String.eqb x c
    end.

  (* what a comparison of parameters says, or its negation *)
  Definition timing (b : bool) (l : side) (o : comparison) (r : side) : option con :=
    match l, r with
    | Fin x, Fin y =>
        match linear x, linear y with
        | Some u, Some v =>
            match o, b with
            | LT, true => Some (true, vsub v u) | LT, false => Some (false, vsub u v)
            | LE, true => Some (false, vsub v u) | LE, false => Some (true, vsub u v)
            | GT, true => Some (true, vsub u v) | GT, false => Some (false, vsub v u)
            | GE, true => Some (false, vsub u v) | GE, false => Some (true, vsub v u)
            end
        | _, _ => None
        end
    | _, _ => None
    end.
  Definition no_road (b : bool) (d : domain) (c : string) : bool :=
    match b, d with
    | false, Lanes => true
    | false, Lanelets (Free x) => String.eqb x c
    | true, Adjacent (Free x) => String.eqb x c
    | _, _ => false
    end.
  Definition no_roads (b : bool) (d : domain) (c : string) (b' : bool) (d' : domain) (c' : string) : bool :=
    (b && negb b' && String.eqb c c' && if domain_dec d d' then true else false)
    || match b, d, b', d' with
       | true, Adjacent (Free x), false, Adjacent (Free y) => String.eqb x c' && String.eqb y c
       | true, Zone z, true, Zone z' => String.eqb c c' && if zone_dec z z' then false else true
       | _, _, _, _ => false
       end.

  Fixpoint check (G : list fact) (C : list con) (tr : tree) : bool :=
    match tr with
    | CloseTruth i => match get i G with Some (At b m (Truth b')) => xorb b b' | _ => false end
    | Close i j w1 w2 =>
        match get i G, get j G with
        | Some (At true m f), Some (At false m' g) =>
            same f g && (rigid f || (entails C (vsub m m') w1 && entails C (vsub m' m) w2))
        | _, _ => false
        end
    | CloseLinear w => farkas C w
    | CloseRoad i => match get i G with Some (Belongs b d c) => no_road b d c | _ => false end
    | CloseRoads i j =>
        match get i G, get j G with
        | Some (Belongs b d c), Some (Belongs b' d' c') => no_roads b d c b' d' c'
        | _, _ => false
        end
    | CloseZones i j k =>
        match get i G, get j G, get k G with
        | Some (Belongs false (Zone main) c), Some (Belongs false (Zone merge) c'), Some (Belongs false (Zone depart) c'') =>
            String.eqb c c' && String.eqb c c''
        | _, _, _ => false
        end
    | Alpha i t =>
        match get i G with
        | Some (At b m (Not f)) => check (At (negb b) m f :: G) C t
        | Some (At true m (And f g)) => check (At true m g :: At true m f :: G) C t
        | Some (At false m (Or f g)) => check (At false m g :: At false m f :: G) C t
        | _ => false
        end
    | Beta i t1 t2 =>
        match get i G with
        | Some (At true m (Or f g)) => check (At true m f :: G) C t1 && check (At true m g :: G) C t2
        | Some (At false m (And f g)) => check (At false m f :: G) C t1 && check (At false m g :: G) C t2
        | _ => false
        end
    | Timing i t =>
        match get i G with
        | Some (At b m (Compare l o r)) =>
            match timing b l o r with Some c => check G (c :: C) t | None => false end
        | _ => false
        end
    | New i n t =>
        fresh n G C &&
        match get i G with
        | Some (At true m (Eventually lo hi f)) =>
            match window m lo hi with
            | Some w => fits n w && check (At true (unit n) f :: G) (window_cons n w C) t | None => false end
        | Some (At false m (Always lo hi f)) =>
            match window m lo hi with
            | Some w => fits n w && check (At false (unit n) f :: G) (window_cons n w C) t | None => false end
        | Some (At true m (Until f lo hi g)) =>
            match window m lo hi with
            | Some w =>
                fits n w && check (Throughout (fst w) (unit n) f :: At true (unit n) g :: G) (window_cons n w C) t
            | None => false end
        | _ => false
        end
    | Inst i m w1 w2 t =>
        match get i G with
        | Some (At false m0 (Eventually lo hi f)) =>
            match window m0 lo hi with
            | Some w => inside C m w w1 w2 && check (At false m f :: G) C t | None => false end
        | Some (At true m0 (Always lo hi f)) =>
            match window m0 lo hi with
            | Some w => inside C m w w1 w2 && check (At true m f :: G) C t | None => false end
        | Some (Throughout lo hi f) =>
            entails C (vsub m lo) w1 && entails_lt C (vsub hi m) w2 && check (At true m f :: G) C t
        | _ => false
        end
    | InstUntil i m w1 w2 n t1 t2 =>
        match get i G with
        | Some (At false m0 (Until f lo hi g)) =>
            match window m0 lo hi with
            | Some w =>
                inside C m w w1 w2 && check (At false m g :: G) C t1 &&
                fresh n G C && fits n w && Nat.leb (length m) n &&
                check (At false (unit n) f :: G)
                  ((true, vsub m (unit n)) :: (false, vsub (unit n) (fst w)) :: C) t2
            | None => false end
        | _ => false
        end
    | NewRoad i c t =>
        forallb (fun f => negb (fact_occurs c f)) G &&
        match get i G with
        | Some (At true m (Some_ n d f)) => check (At true m (inst n c f) :: Belongs true d c :: G) C t
        | Some (At false m (Every n d f)) => check (At false m (inst n c f) :: Belongs true d c :: G) C t
        | _ => false
        end
    | InstRoad i c t1 t2 =>
        match get i G with
        | Some (At false m (Some_ n d f)) =>
            check (Belongs false d c :: G) C t1 && check (At false m (inst n c f) :: G) C t2
        | Some (At true m (Every n d f)) =>
            check (Belongs false d c :: G) C t1 && check (At true m (inst n c f) :: G) C t2
        | _ => false
        end
    | Cut v t1 t2 => check G ((false, v) :: C) t1 && check G ((true, vscale (-1 # 1) v) :: C) t2
    | Fact k m t =>
        match nth_error facts k with Some f => check (At true m f :: G) C t | None => false end
    end.

  (* --- what facts mean, and that each rule keeps it ---------------------------------------------------- *)
  Variable W : world.
  Notation free := (unbound W).
  Hypothesis facts_hold : forall named t f, In f facts -> holds W named free t f.

  Definition true_of (named : string -> element W) (r : nat -> R) (f : fact) : Prop :=
    match f with
    | At true m f => holds W named free (veval m r) f
    | At false m f => ~ holds W named free (veval m r) f
    | Throughout lo hi f => forall w, veval lo r <= w < veval hi r -> holds W named free w f
    | Belongs true d c => member W named free d (named c)
    | Belongs false d c => ~ member W named free d (named c)
    end.
  Definition good (r : nat -> R) : Prop :=
    r O = 1 /\ forall i p, nth_error ps i = Some p -> r (S i) = parameter W p.
  Definition stand named r G C :=
    (forall f, In f G -> true_of named r f) /\ (forall c, In c C -> chold r c).

  Lemma index_nth p l : forall i, index p l = Some i -> nth_error l i = Some p.
  Proof.
    induction l as [|q l IH]; intros i H; simpl in H; [discriminate|].
    destruct (String.eqb_spec q p) as [->|_]; [injection H as <-; reflexivity|].
    destruct (index p l); [|discriminate]. injection H as <-. simpl. auto.
  Qed.
  Lemma veval_constant q r : r O = 1 -> veval [q] r = Q2R q.
  Proof. intros E. cbn [veval]. rewrite E. lra. Qed.
  Lemma linear_sound r t x : good r -> forall v, linear x = Some v -> veval v r = number W t x.
  Proof.
    intros [R1 RP]. induction x; intros v H; cbn [linear] in H; try discriminate.
    - injection H as <-. rewrite veval_constant by assumption. reflexivity.
    - destruct (index name ps) as [i|] eqn:E; [|discriminate]. injection H as <-.
      change (0%Q :: unit i) with (unit (S i)). rewrite veval_unit. apply RP, index_nth, E.
    - destruct (linear x1), (linear x2); try discriminate. injection H as <-.
      rewrite veval_add. cbn [number]. rewrite (IHx1 _ eq_refl), (IHx2 _ eq_refl). reflexivity.
    - cbn [number]. destruct (linear x1) as [u|]; [|discriminate].
      destruct (linear x2) as [w|]; [|destruct u as [|? []]; discriminate].
      rewrite <- (IHx1 _ eq_refl), <- (IHx2 _ eq_refl).
      destruct u as [|p [|p' u]], w as [|q [|q' w]]; cbv beta iota in H; try discriminate;
        match type of H with Some ?x = Some _ => assert (E : v = x) by congruence; rewrite E, veval_scale end;
        cbn [veval]; rewrite ?R1; ring.
    - cbn [number]. destruct (linear x1) as [u|]; [|discriminate]. destruct (linear x2) as [w|]; [|discriminate].
      rewrite <- (IHx1 _ eq_refl), <- (IHx2 _ eq_refl).
      destruct w as [|q [|q' w]]; try discriminate. destruct (Qeq_bool q 0) eqn:Z; [discriminate|].
      assert (E : v = vscale (/ q) u) by congruence.
      rewrite E, veval_scale, (veval_constant q r R1), Q2R_inv; [unfold Rdiv; ring|].
      intros A. apply Qeq_bool_iff in A. congruence.
  Qed.

  Definition set (r : nat -> R) n x k := if Nat.eqb k n then x else r k.
  Lemma veval_set v r n x : (length v <= n)%nat -> veval v (set r n x) = veval v r.
  Proof.
    intros L. apply veval_agree. intros k K. unfold set. destruct (Nat.eqb_spec k n); [lia|reflexivity].
  Qed.
  Lemma set_same r n x : veval (unit n) (set r n x) = x.
  Proof. rewrite veval_unit. unfold set. rewrite Nat.eqb_refl. reflexivity. Qed.
  Lemma fresh_sound n G C named r x : fresh n G C = true -> good r -> stand named r G C ->
    good (set r n x) /\ stand named (set r n x) G C.
  Proof.
    unfold fresh. intros F [R1 RP] [HG HC].
    apply andb_prop in F as [F F3]. apply andb_prop in F as [F1 F2].
    apply Nat.ltb_lt in F1. rewrite forallb_forall in F2, F3.
    split; [split|split].
    - unfold set. destruct (Nat.eqb_spec 0 n); [lia|assumption].
    - intros i p E. assert (i < length ps)%nat by (apply nth_error_Some; congruence).
      unfold set. destruct (Nat.eqb_spec (S i) n); [lia|auto].
    - intros f I. pose proof (HG f I) as H. pose proof (F2 f I) as L. apply Nat.leb_le in L.
      destruct f as [[|] m f|lo hi f|[|] d c]; simpl in *; rewrite ?veval_set by lia; assumption.
    - intros c I. pose proof (HC c I) as H. pose proof (F3 c I) as L. apply Nat.leb_le in L.
      unfold chold in *. rewrite veval_set by lia. assumption.
  Qed.
  Lemma stand_fact named r f G C : true_of named r f -> stand named r G C -> stand named r (f :: G) C.
  Proof. intros H [A B]. split; [intros g [<-|I]; auto|assumption]. Qed.
  Lemma stand_con named r c G C : chold r c -> stand named r G C -> stand named r G (c :: C).
  Proof. intros H [A B]. split; [assumption|intros g [<-|I]; auto]. Qed.

  (* what a window means *)
  Definition in_window r (w : vec * option vec) u : Prop :=
    veval (fst w) r <= u /\ match snd w with None => True | Some b => u <= veval b r end.
  Lemma window_sound m lo hi w r : good r -> window m lo hi = Some w ->
    (forall u, in_window r w u <-> within W (veval m r) lo hi u)
    /\ veval (fst w) r = veval m r + number W (veval m r) lo.
  Proof.
    intros R H. unfold window in H. destruct (linear lo) as [a|] eqn:A; [|discriminate].
    pose proof (linear_sound r (veval m r) lo R a A) as EA.
    destruct hi as [b|].
    - destruct (linear b) as [b'|] eqn:B; [|discriminate]. injection H as <-.
      pose proof (linear_sound r (veval m r) b R b' B) as EB.
      unfold in_window, within; simpl. rewrite !veval_add, EA, EB. split; [tauto|reflexivity].
    - injection H as <-. unfold in_window, within; simpl. rewrite veval_add, EA. split; [tauto|reflexivity].
  Qed.
  Lemma inside_sound C m w w1 w2 r : r O = 1 -> (forall c, In c C -> chold r c) ->
    inside C m w w1 w2 = true -> in_window r w (veval m r).
  Proof.
    intros R1 HC H. unfold inside in H. apply andb_prop in H as [H1 H2].
    pose proof (entails_sound C r _ _ R1 HC H1) as E1. rewrite veval_sub in E1.
    split; [lra|]. destruct (snd w); [|trivial].
    pose proof (entails_sound C r _ _ R1 HC H2) as E2. rewrite veval_sub in E2. lra.
  Qed.
  (* the constraints of a window hold of a new moment in it, where its ends are old *)
  Lemma window_cons_sound n w C G named r u : (length (fst w) <= n)%nat ->
    match snd w with None => True | Some b => (length b <= n)%nat end ->
    in_window r w u -> stand named (set r n u) G C -> stand named (set r n u) G (window_cons n w C).
  Proof.
    destruct w as [a o]. unfold in_window, window_cons. cbn [fst snd]. intros L1 L2 [I1 I2] H.
    assert (H1 : stand named (set r n u) G ((false, vsub (unit n) a) :: C)).
    { apply stand_con; [|assumption]. unfold chold; simpl.
      rewrite veval_sub, set_same, veval_set by lia. lra. }
    destruct o as [b|]; [|assumption].
    apply stand_con; [|assumption]. unfold chold; simpl.
    rewrite veval_sub, set_same, veval_set by lia. lra.
  Qed.
  Lemma fits_length n w : fits n w = true -> (length (fst w) <= n)%nat /\
    match snd w with None => True | Some b => (length b <= n)%nat end.
  Proof.
    unfold fits. intros H. apply andb_prop in H as [H1 H2]. apply Nat.leb_le in H1.
    split; [assumption|]. destruct (snd w); [apply Nat.leb_le; assumption|trivial].
  Qed.
  Lemma timing_sound r t named b l o y c : good r -> timing b l o y = Some c ->
    (if b then holds W named free t (Compare l o y) else ~ holds W named free t (Compare l o y)) -> chold r c.
  Proof.
    intros R H. unfold timing in H. destruct l as [x|]; [|discriminate]. destruct y as [y|]; [|discriminate].
    destruct (linear x) as [u|] eqn:U; [|discriminate]. destruct (linear y) as [v|] eqn:V; [|discriminate].
    pose proof (linear_sound r t x R u U) as EU. pose proof (linear_sound r t y R v V) as EV.
    destruct o, b; injection H as <-; simpl; unfold chold; simpl; rewrite veval_sub, EU, EV; lra.
  Qed.
  Lemma no_road_sound named r b d c : no_road b d c = true -> true_of named r (Belongs b d c) -> False.
  Proof.
    destruct b, d as [|[x|n]|[x|n]|z]; simpl; intros H A; try discriminate;
      try (apply String.eqb_eq in H as ->).
    - exact (adjacent_irreflexive W _ A).
    - exact (A I).
    - apply A, lanelets_reflexive.
  Qed.
  Lemma no_roads_sound named r b d c b' d' c' : no_roads b d c b' d' c' = true ->
    true_of named r (Belongs b d c) -> true_of named r (Belongs b' d' c') -> False.
  Proof.
    unfold no_roads. intros H A B. apply orb_prop in H as [H|H].
    - apply andb_prop in H as [H D]. apply andb_prop in H as [H E]. apply andb_prop in H as [S S'].
      destruct (domain_dec d d') as [<-|]; [|discriminate]. apply String.eqb_eq in E as <-.
      destruct b, b'; try discriminate. exact (B A).
    - destruct b, d as [|[x|n]|[x|n]|z]; try discriminate; destruct b', d' as [|[x'|n']|[x'|n']|z']; try discriminate;
        apply andb_prop in H as [E D]; apply String.eqb_eq in E as ->.
      + apply String.eqb_eq in D as ->. simpl in A, B. apply B, adjacent_symmetric, A.
      + simpl in A, B. destruct (zone_dec z z') as [|N]; [discriminate|]. apply N. congruence.
  Qed.
  Lemma rename_sound c named e r G C : forallb (fun f => negb (fact_occurs c f)) G = true ->
    stand named r G C -> stand (rename W named c e) r G C.
  Proof.
    intros F [HG HC]. split; [|assumption]. rewrite forallb_forall in F. intros f I.
    pose proof (HG f I) as H. pose proof (F f I) as O. apply negb_true_iff in O.
    destruct f as [[|] m f|lo hi f|[|] d c']; simpl in *.
    - apply holds_fresh; assumption.
    - intros S. apply H. apply (holds_fresh W f named c e O). assumption.
    - intros w Hw. apply holds_fresh; auto.
    - apply orb_false_iff in O as [O1 O2]. apply member_fresh; [assumption|]. unfold rename. rewrite O2. assumption.
    - apply orb_false_iff in O as [O1 O2]. intros S. apply H.
      apply (member_fresh W named c e free d) in S; [|assumption]. unfold rename in S. rewrite O2 in S. assumption.
  Qed.
  Lemma inst_one named n c f t :
    holds W named free t (inst n c f) <-> holds W named (bind W free n (named c)) t f.
  Proof. apply holds_inst. Qed.
  Lemma rename_same named c e : rename W named c e c = e.
  Proof. unfold rename. rewrite String.eqb_refl. reflexivity. Qed.

  Ltac split_and := repeat match goal with H : _ && _ = true |- _ => apply andb_prop in H as [? ?] end.

  Theorem check_sound tr : forall named r G C, good r -> stand named r G C -> check G C tr = true -> False.
  Proof.
    induction tr as [i|i j w1 w2|w|i|i j|i j k|i t IH|i t1 IH1 t2 IH2|i t IH|i n t IH|i m w1 w2 t IH
      |i m w1 w2 n t1 IH1 t2 IH2|i c t IH|i c t1 IH1 t2 IH2|v t1 IH1 t2 IH2|k m t IH];
      intros named r G C R H K; cbn [check] in K.
    - (* CloseTruth *)
      destruct (get i G) as [[b m [b'| | | | | | | | | |]| |]|] eqn:E; try discriminate.
      apply get_in, (proj1 H) in E. destruct b, b'; simpl in *; try discriminate; auto.
    - (* Close *)
      destruct (get i G) as [[[|] m f| |]|] eqn:E; try discriminate.
      destruct (get j G) as [[[|] m' g| |]|] eqn:E'; try discriminate.
      apply andb_prop in K as [K1 K2]. apply same_eq in K1 as <-.
      apply get_in, (proj1 H) in E. apply get_in, (proj1 H) in E'. simpl in E, E'.
      apply orb_prop in K2 as [K2|K2].
      + apply E'. apply (holds_rigid W f named free _ _ K2) with (1 := E).
      + apply andb_prop in K2 as [A B].
        pose proof (entails_sound C r _ _ (proj1 R) (proj2 H) A) as A'.
        pose proof (entails_sound C r _ _ (proj1 R) (proj2 H) B) as B'.
        rewrite veval_sub in A', B'. replace (veval m' r) with (veval m r) in E' by lra. auto.
    - (* CloseLinear *) exact (farkas_sound C r w (proj1 R) (proj2 H) K).
    - (* CloseRoad *)
      destruct (get i G) as [[| |b d c]|] eqn:E; try discriminate.
      apply get_in, (proj1 H) in E. exact (no_road_sound named r b d c K E).
    - (* CloseRoads *)
      destruct (get i G) as [[| |b d c]|] eqn:E; try discriminate.
      destruct (get j G) as [[| |b' d' c']|] eqn:E'; try discriminate.
      apply get_in, (proj1 H) in E. apply get_in, (proj1 H) in E'.
      exact (no_roads_sound named r b d c b' d' c' K E E').
    - (* CloseZones *)
      destruct (get i G) as [[| |[|] [| | |[| |]] c]|] eqn:E; try discriminate.
      destruct (get j G) as [[| |[|] [| | |[| |]] c']|] eqn:E'; try discriminate.
      destruct (get k G) as [[| |[|] [| | |[| |]] c'']|] eqn:E''; try discriminate.
      apply andb_prop in K as [K1 K2]. apply String.eqb_eq in K1 as <-. apply String.eqb_eq in K2 as <-.
      apply get_in, (proj1 H) in E. apply get_in, (proj1 H) in E'. apply get_in, (proj1 H) in E''.
      simpl in E, E', E''. destruct (zone_of W (named c)); auto.
    - (* Alpha *)
      destruct (get i G) as [[b m f| |]|] eqn:E; try discriminate.
      apply get_in, (proj1 H) in E.
      destruct f; try (destruct b; discriminate).
      + destruct b; (refine (IH named r _ _ R _ K); apply stand_fact; [|assumption]);
          simpl in *; [assumption|apply NNPP; assumption].
      + destruct b; [|discriminate]. simpl in E. destruct E.
        refine (IH named r _ _ R _ K). repeat (apply stand_fact; [assumption|]). assumption.
      + destruct b; [discriminate|]. simpl in E. apply not_or_and in E as [? ?].
        refine (IH named r _ _ R _ K). repeat (apply stand_fact; [assumption|]). assumption.
    - (* Beta *)
      destruct (get i G) as [[[|] m f| |]|] eqn:E; try discriminate;
        apply get_in, (proj1 H) in E; destruct f; try discriminate; split_and; simpl in E.
      + destruct E as [E|E].
        * refine (IH1 named r _ _ R _ H0). apply stand_fact; assumption.
        * refine (IH2 named r _ _ R _ H1). apply stand_fact; assumption.
      + apply not_and_or in E as [E|E].
        * refine (IH1 named r _ _ R _ H0). apply stand_fact; assumption.
        * refine (IH2 named r _ _ R _ H1). apply stand_fact; assumption.
    - (* Timing *)
      destruct (get i G) as [[b m f| |]|] eqn:E; try discriminate. destruct f; try discriminate.
      destruct (timing b l o r0) as [c|] eqn:T; [|discriminate].
      apply get_in, (proj1 H) in E.
      refine (IH named r _ _ R _ K). apply stand_con; [|assumption].
      apply (timing_sound r (veval m r) named b l o r0 c R T). destruct b; exact E.
    - (* New *)
      apply andb_prop in K as [F K].
      destruct (get i G) as [[[|] m f| |]|] eqn:E; try discriminate;
        apply get_in, (proj1 H) in E; destruct f as [| | | | | | | |f lo hi g|lo hi f|lo hi f]; try discriminate;
        (destruct (window m lo hi) as [w|] eqn:X; [|discriminate]);
        apply andb_prop in K as [L K]; apply fits_length in L as [L1 L2];
        destruct (window_sound _ _ _ _ r R X) as [IW LW]; simpl in E.
      + destruct E as [u [U1 [U2 U3]]]. apply IW in U1.
        destruct (fresh_sound n G C named r u F R H) as [R' H'].
        refine (IH named (set r n u) _ _ R' _ K).
        apply stand_fact; [|apply stand_fact; [|apply (window_cons_sound n w C G named r u); assumption]].
        * simpl. intros x Hx. rewrite set_same, veval_set in Hx by assumption. rewrite LW in Hx. apply U3. assumption.
        * simpl. rewrite set_same. assumption.
      + destruct E as [u [U1 U2]]. apply IW in U1.
        destruct (fresh_sound n G C named r u F R H) as [R' H'].
        refine (IH named (set r n u) _ _ R' _ K).
        apply stand_fact; [|apply (window_cons_sound n w C G named r u); assumption].
        simpl. rewrite set_same. assumption.
      + apply not_all_ex_not in E as [u E]. apply imply_to_and in E as [U1 U2]. apply IW in U1.
        destruct (fresh_sound n G C named r u F R H) as [R' H'].
        refine (IH named (set r n u) _ _ R' _ K).
        apply stand_fact; [|apply (window_cons_sound n w C G named r u); assumption].
        simpl. rewrite set_same. assumption.
    - (* Inst *)
      destruct (get i G) as [[[|] m0 f|lo hi f|]|] eqn:E; try discriminate;
        apply get_in, (proj1 H) in E.
      + destruct f as [| | | | | | | |f lo hi g|lo hi f|lo hi f]; try discriminate.
        destruct (window m0 lo hi) as [w|] eqn:X; [|discriminate].
        apply andb_prop in K as [I K]. apply (inside_sound C m w w1 w2 r (proj1 R) (proj2 H)) in I.
        refine (IH named r _ _ R _ K). apply stand_fact; [|assumption]. simpl in *.
        apply E, (window_sound _ _ _ _ r R X); assumption.
      + destruct f as [| | | | | | | |f lo hi g|lo hi f|lo hi f]; try discriminate.
        destruct (window m0 lo hi) as [w|] eqn:X; [|discriminate].
        apply andb_prop in K as [I K]. apply (inside_sound C m w w1 w2 r (proj1 R) (proj2 H)) in I.
        refine (IH named r _ _ R _ K). apply stand_fact; [|assumption]. simpl in *.
        intros S. apply E. exists (veval m r). split; [|assumption].
        apply (window_sound _ _ _ _ r R X); assumption.
      + apply andb_prop in K as [K K3]. apply andb_prop in K as [K1 K2].
        pose proof (entails_sound C r _ _ (proj1 R) (proj2 H) K1) as A.
        pose proof (entails_lt_sound C r _ _ (proj1 R) (proj2 H) K2) as B.
        rewrite veval_sub in A, B. simpl in E.
        refine (IH named r _ _ R _ K3). apply stand_fact; [|assumption]. simpl. apply E. lra.
    - (* InstUntil *)
      destruct (get i G) as [[[|] m0 f| |]|] eqn:E; try discriminate;
        apply get_in, (proj1 H) in E.
      destruct f as [| | | | | | | |f lo hi g|lo hi f|lo hi f]; try discriminate.
      destruct (window m0 lo hi) as [w|] eqn:X; [|discriminate].
      apply andb_prop in K as [K K2]. apply andb_prop in K as [K LM]. apply andb_prop in K as [K L].
      apply andb_prop in K as [K F]. apply andb_prop in K as [I K1].
      apply (inside_sound C m w w1 w2 r (proj1 R) (proj2 H)) in I.
      destruct (window_sound _ _ _ _ r R X) as [IW LW].
      apply fits_length in L as [L1 _]. apply Nat.leb_le in LM.
      destruct (classic (holds W named free (veval m r) g)) as [S|S].
      + simpl in E.
        assert (Y : exists x, (veval m0 r + number W (veval m0 r) lo <= x < veval m r) /\ ~ holds W named free x f).
        { apply NNPP. intros N. apply E. exists (veval m r). split; [apply IW; assumption|]. split; [assumption|].
          intros x Hx. apply NNPP. intros Y. apply N. exists x. split; assumption. }
        destruct Y as [x [X1 X2]]. rewrite <- LW in X1.
        destruct (fresh_sound n G C named r x F R H) as [R' H'].
        refine (IH2 named (set r n x) _ _ R' _ K2).
        apply stand_fact; [simpl; rewrite set_same; assumption|].
        apply stand_con; [unfold chold; simpl; rewrite veval_sub, set_same, veval_set by assumption; lra|].
        apply stand_con; [unfold chold; simpl; rewrite veval_sub, set_same, veval_set by assumption; lra|].
        assumption.
      + refine (IH1 named r _ _ R _ K1). apply stand_fact; assumption.
    - (* NewRoad *)
      apply andb_prop in K as [F K].
      destruct (get i G) as [[[|] m f| |]|] eqn:E; try discriminate; pose proof (get_in _ _ _ E) as I;
        pose proof (proj1 H _ I) as X; simpl in X; destruct f; try discriminate.
      + destruct X as [e [X1 X2]].
        refine (IH (rename W named c e) r _ _ R _ K).
        rewrite forallb_forall in F. pose proof (F _ I) as O. apply negb_true_iff in O. simpl in O.
        apply orb_false_iff in O as [O1 O2].
        apply stand_fact; [|apply stand_fact; [|apply rename_sound; [apply forallb_forall|]; assumption]].
        * simpl. apply inst_one. rewrite rename_same. apply holds_fresh; assumption.
        * simpl. rewrite rename_same. apply member_fresh; assumption.
      + apply not_all_ex_not in X as [e X]. apply imply_to_and in X as [X1 X2].
        refine (IH (rename W named c e) r _ _ R _ K).
        rewrite forallb_forall in F. pose proof (F _ I) as O. apply negb_true_iff in O. simpl in O.
        apply orb_false_iff in O as [O1 O2].
        apply stand_fact; [|apply stand_fact; [|apply rename_sound; [apply forallb_forall|]; assumption]].
        * simpl. intros S. apply inst_one in S. rewrite rename_same in S. apply X2.
          apply (holds_fresh W f named c e O2). assumption.
        * simpl. rewrite rename_same. apply member_fresh; assumption.
    - (* InstRoad *)
      destruct (get i G) as [[[|] m f| |]|] eqn:E; try discriminate; apply get_in, (proj1 H) in E; simpl in E;
        destruct f; try discriminate; apply andb_prop in K as [K1 K2];
        destruct (classic (member W named free d (named c))) as [S|S].
      1, 3: refine (IH2 named r _ _ R _ K2); apply stand_fact; [|assumption]; simpl.
      + apply inst_one, E, S.
      + intros Y. apply inst_one in Y. apply E. exists (named c). split; assumption.
      + refine (IH1 named r _ _ R _ K1). apply stand_fact; assumption.
      + refine (IH1 named r _ _ R _ K1). apply stand_fact; assumption.
    - (* Cut *)
      apply andb_prop in K as [K1 K2]. destruct (Rle_dec 0 (veval v r)) as [L|L].
      + refine (IH1 named r _ _ R _ K1). apply stand_con; assumption.
      + refine (IH2 named r _ _ R _ K2). apply stand_con; [|assumption].
        unfold chold; simpl. rewrite veval_scale, Q2R_m1. lra.
    - (* Fact *)
      destruct (nth_error facts k) as [f|] eqn:E; [|discriminate].
      refine (IH named r _ _ R _ K). apply stand_fact; [|assumption].
      simpl. apply facts_hold. apply nth_error_In in E. assumption.
  Qed.
End Check.

(* How tableaux are printed: a rational, and a constraint with its multiplier. *)
Definition q (z : Z) (p : positive) : Q := Qmake z p.
Definition by_ (n : nat) (k : Q) : nat * Q := (n, k).

(* --- claims --------------------------------------------------------------------------------------------- *)
Fixpoint bound_cons (ps : list string) (bounds : list bound) : list con :=
  match bounds with
  | [] => []
  | b :: bounds =>
      let named := match b with at_least_0 p => Some (p, false) | above_0 p => Some (p, true) | _ => None end in
      match named with
      | Some (p, strict) =>
          match index p ps with Some i => (strict, unit (S i)) :: bound_cons ps bounds | None => bound_cons ps bounds end
      | None => bound_cons ps bounds
      end
  end.
Definition accepts ps bounds facts claim tr : bool :=
  check ps facts [At false [] claim] (bound_cons ps bounds) tr.

Theorem accepted ps bounds facts claim tr :
  Forall (valid_always bounds) facts -> accepts ps bounds facts claim tr = true -> valid bounds claim.
Proof.
  intros HL HA W named HB. apply NNPP. intros N.
  set (r := fun n => match n with O => 1 | S i => match nth_error ps i with Some p => parameter W p | None => 0 end end).
  assert (R : good ps W r). { split; [reflexivity|]. intros i p E. simpl. rewrite E. reflexivity. }
  refine (check_sound ps facts W _ tr named r _ _ R _ HA).
  - intros named' t f I. rewrite Forall_forall in HL. apply (HL f I). assumption.
  - split.
    + intros f [<-|[]]. exact N.
    + clear HA HL N. unfold respects in HB. induction bounds as [|b bounds IH]; simpl; [intros c []|].
      inversion HB as [|x l B1 B2]; subst. specialize (IH B2).
      destruct b as [p|p| |]; try exact IH; intros c I; (destruct (index p ps) as [i|] eqn:E; [|apply IH; assumption]);
        (destruct I as [<-|I]; [|apply IH; assumption]); unfold chold; cbn [fst snd];
        change (0%Q :: unit i) with (unit (S i)); rewrite veval_unit; unfold r; rewrite (index_nth _ _ _ E); exact B1.
Qed.
