(* What is said, and what it means.  TRUSTED: read this file, Text.v and the printed claim.

   Signal temporal logic over dense time as roadproof writes it (docs/reference/language.md,
   docs/explanation/formal.md): terms of real numbers, formulas, the worlds that they speak of, and when a formula is
   true of a world at a time.
   `valid` says what it is for a claim to hold always.  Nothing here is about proofs. *)
From Coq Require Import Reals QArith Qreals String List Arith.
Import ListNotations.
Open Scope R_scope.

Definition vehicle := string.

(* --- syntax ------------------------------------------------------------------------------------------- *)

(* Signals change with time, sizes do not.  Own: a signal that a specification declares; of no vehicle is one of
   the vehicle "".  It is a number; one that is true or false is true above 1/2.
   Kind: a number that says what a vehicle is: below 3/2 a car, from there on and below 5/2 a truck, from there on
   and below 7/2 a bus, from there on and below 9/2 a motorcycle, from there on something else. *)
Inductive signal :=
| Place_lon | Place_lat | Speed_lon | Speed_lat | Acceleration_lon | Acceleration_lat | Jerk_lon | Own (name : string).
Inductive size := Length | Width | Kind.

(* Par: a parameter of the specification.  Var: a number that the claim speaks of (`given v: m/s`). *)
Inductive term :=
| Num (q : Q)
| Par (name : string)
| Var (name : string)
| Sig (n : signal) (a : vehicle)
| Siz (n : size) (a : vehicle)
| Add (x y : term)
| Mul (x y : term)
| Pow (x : term) (n : nat)
| Div (x y : term)
| Max (x y : term)
| Min (x y : term).

(* One side of a comparison: Fin x is x, and Inv x is 1/x, which is infinite where x = 0. *)
Inductive side := Fin (x : term) | Inv (x : term).
Inductive comparison := LT | LE | GT | GE.

(* A lane or lanelet: the one called x, or the one that the quantifier with number n speaks of. *)
Inductive road := Free (x : string) | Bound (n : nat).
Inductive zone := main | merge | depart.
Inductive domain := Lanes | Adjacent (l : road) | Lanelets (l : road) | Zone (z : zone).

(* Intervals are closed; where the upper end is None there is none. *)
Inductive formula :=
| Truth (b : bool)
| Compare (l : side) (o : comparison) (r : side)
| Occupies (a : vehicle) (l : road)
| Some_ (n : nat) (d : domain) (f : formula)
| Every (n : nat) (d : domain) (f : formula)
| Not (f : formula)
| And (f g : formula)
| Or (f g : formula)
| Until (f : formula) (lo : term) (hi : option term) (g : formula)
| Eventually (lo : term) (hi : option term) (f : formula)
| Always (lo : term) (hi : option term) (f : formula).

(* A quantifier is written with a function, such as fun l => Occupies a l.  Its number is above those of all
   quantifiers inside, so that it is mistaken for none of them, and none of them for it. *)
Fixpoint height (f : formula) : nat :=
  match f with
  | Some_ n _ f | Every n _ f => Nat.max (S n) (height f)
  | Not f | Eventually _ _ f | Always _ _ f => height f
  | And f g | Or f g | Until f _ _ g => Nat.max (height f) (height g)
  | _ => 0%nat
  end.
Definition some_in (d : domain) (f : road -> formula) : formula :=
  let n := height (f (Free "")) in Some_ n d (f (Bound n)).
Definition every_in (d : domain) (f : road -> formula) : formula :=
  let n := height (f (Free "")) in Every n d (f (Bound n)).

(* --- meaning ------------------------------------------------------------------------------------------ *)

(* A rectangle along and across the road; an end along it is None where it goes on for ever. *)
Record extent := { s_from : option R; s_to : option R; d_from : R; d_to : R }.

(* A world: signals are any functions of time, sizes are above zero, and the road is any.
   An element of the road is a lanelet, and stands for the lane that it belongs to as well: so every element
   stands for a lane, and is one of the lanelets of that lane.  Every lanelet is a rectangle in one zone.  No lane is
   beside itself. *)
Record world := {
  element : Type;
  somewhere : element;
  parameter : string -> R;
  variable : string -> R;
  value : signal -> vehicle -> R -> R;
  measure : size -> vehicle -> R;
  measure_positive : forall n a, 0 < measure n a;
  shape : element -> extent;
  adjacent : element -> element -> Prop;
  adjacent_irreflexive : forall l, ~ adjacent l l;
  adjacent_symmetric : forall l m, adjacent l m -> adjacent m l;
  lanelets : element -> element -> Prop;
  lanelets_reflexive : forall l, lanelets l l;
  zone_of : element -> zone }.

(* A box reaches from its front-left corner back by the length and to the right by the width.  A vehicle occupies a
   lanelet where the insides of both overlap: touching is not enough. *)
Definition occupies (W : world) (a : vehicle) (e : element W) (t : R) : Prop :=
  match s_from (shape W e) with None => True | Some b => b < value W Place_lon a t end
  /\ match s_to (shape W e) with None => True | Some b => value W Place_lon a t - measure W Length a < b end
  /\ d_from (shape W e) < value W Place_lat a t
  /\ value W Place_lat a t - measure W Width a < d_to (shape W e).

Section Meaning.
  Variable W : world.

  Fixpoint number (t : R) (x : term) : R :=
    match x with
    | Num q => Q2R q
    | Par p => parameter W p
    | Var v => variable W v
    | Sig n a => value W n a t
    | Siz n a => measure W n a
    | Add x y => number t x + number t y
    | Mul x y => number t x * number t y
    | Pow x n => pow (number t x) n
    | Div x y => number t x / number t y
    | Max x y => Rmax (number t x) (number t y)
    | Min x y => Rmin (number t x) (number t y)
    end.

  Inductive extended := Real (x : R) | Infinity.
  Definition extended_number (t : R) (s : side) : extended :=
    match s with
    | Fin x => Real (number t x)
    | Inv x => if Req_EM_T (number t x) 0 then Infinity else Real (/ number t x)
    end.
  Definition less (a b : extended) : Prop :=
    match a, b with Real x, Real y => x < y | Real _, Infinity => True | Infinity, _ => False end.
  Definition at_most (a b : extended) : Prop :=
    match a, b with Real x, Real y => x <= y | _, Infinity => True | Infinity, Real _ => False end.
  Definition compares (o : comparison) (a b : extended) : Prop :=
    match o with LT => less a b | LE => at_most a b | GT => less b a | GE => at_most b a end.

  Variable named : string -> element W.                     (* what L and the like stand for *)
  Definition place (bound : nat -> element W) (l : road) : element W :=
    match l with Free x => named x | Bound n => bound n end.
  Definition bind (bound : nat -> element W) (n : nat) (e : element W) : nat -> element W :=
    fun k => if Nat.eqb k n then e else bound k.
  Definition member (bound : nat -> element W) (d : domain) (e : element W) : Prop :=
    match d with
    | Lanes => True
    | Adjacent l => adjacent W (place bound l) e
    | Lanelets l => lanelets W (place bound l) e
    | Zone z => zone_of W e = z
    end.
  (* u is in t + [lo, hi] *)
  Definition within (t : R) (lo : term) (hi : option term) (u : R) : Prop :=
    t + number t lo <= u /\ match hi with None => True | Some b => u <= t + number t b end.

  Fixpoint holds (bound : nat -> element W) (t : R) (f : formula) : Prop :=
    match f with
    | Truth b => b = true
    | Compare l o r => compares o (extended_number t l) (extended_number t r)
    | Occupies a l => occupies W a (place bound l) t
    | Some_ n d f => exists e, member bound d e /\ holds (bind bound n e) t f
    | Every n d f => forall e, member bound d e -> holds (bind bound n e) t f
    | Not f => ~ holds bound t f
    | And f g => holds bound t f /\ holds bound t g
    | Or f g => holds bound t f \/ holds bound t g
    | Until f lo hi g =>
        exists u, within t lo hi u /\ holds bound u g
                  /\ forall w, t + number t lo <= w < u -> holds bound w f
    | Eventually lo hi f => exists u, within t lo hi u /\ holds bound u f
    | Always lo hi f => forall u, within t lo hi u -> holds bound u f
    end.
End Meaning.

(* The bounds that a specification declares of its parameters, and of its signals at all times. *)
Inductive bound :=
| at_least_0 (name : string)
| above_0 (name : string)
| own_at_least (name : string) (a : vehicle) (low : Q)
| own_at_most (name : string) (a : vehicle) (high : Q).
Definition keeps_to (W : world) (b : bound) : Prop :=
  match b with
  | at_least_0 p => 0 <= parameter W p
  | above_0 p => 0 < parameter W p
  | own_at_least n a low => forall t, Q2R low <= value W (Own n) a t
  | own_at_most n a high => forall t, value W (Own n) a t <= Q2R high
  end.
Definition respects (W : world) (bounds : list bound) : Prop := Forall (keeps_to W) bounds.
Definition unbound (W : world) : nat -> element W := fun _ => somewhere W.

(* The claim holds at time 0 in every world, for all parameters within their bounds. *)
Definition valid (bounds : list bound) (claim : formula) : Prop :=
  forall (W : world) (named : string -> element W), respects W bounds -> holds W named (unbound W) 0 claim.
(* A fact about one instant holds at every time. *)
Definition valid_always (bounds : list bound) (fact : formula) : Prop :=
  forall (W : world) (named : string -> element W) (t : R), respects W bounds -> holds W named (unbound W) t fact.
