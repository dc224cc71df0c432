(* How claims are written.  TRUSTED: notations that let a printed claim be read beside its .spec.

   Terms and formulas look as they do in roadproof's language: `v_lon a < v_lon b`, `F[0, minDanger] p`,
   `p U[0, inf) q`, `some l in lanelets L, occ a l`.  `not` binds tightest, then F, G, comparisons, U, `and`,
   `or`, `->`.  What `->` and `<->` stand for is said here, since formulas have no such nodes. *)
From Coq Require Import QArith ZArith String List.
From Roadproof Require Import Meaning.

Definition s := Sig Place_lon.
Definition d := Sig Place_lat.
Definition v_lon := Sig Speed_lon.
Definition v_lat := Sig Speed_lat.
Definition a_lon := Sig Acceleration_lon.
Definition a_lat := Sig Acceleration_lat.
Definition j_lon := Sig Jerk_lon.
Definition length := Siz Length.
Definition width := Siz Width.
Definition kind := Siz Kind.
Definition occ := Occupies.
Definition lanes := Lanes.
Definition adjacentLanes := Adjacent.
Definition lanelets := Lanelets.
Definition zone := Zone.

Declare Scope term_scope.
Delimit Scope term_scope with term.
Bind Scope term_scope with term.
Declare Scope formula_scope.
Delimit Scope formula_scope with formula.
Bind Scope formula_scope with formula.

(* Whole numbers are written as they are; 3 # 5 is the number three fifths. *)
Definition whole (z : Z) : term := Num (z # 1).
Definition as_whole (x : term) : option Z := match x with Num (z # 1) => Some z | _ => None end.
Number Notation term whole as_whole : term_scope.
Notation "p # q" := (Num (Qmake p%Z q%positive)) (at level 55, no associativity) : term_scope.

Notation "x + y" := (Add x y) : term_scope.
Notation "x - y" := (Add x (Mul (Num (-1 # 1)) y)) : term_scope.
Notation "- x" := (Mul (Num (-1 # 1)) x) : term_scope.
Notation "x * y" := (Mul x y) : term_scope.
Notation "x / y" := (Div x y) : term_scope.
Notation "x ^ n" := (Pow x n%nat) : term_scope.
Notation "'max' ( x , y )" := (Max x y) (at level 0, x at level 99, y at level 99) : term_scope.
Notation "'min' ( x , y )" := (Min x y) (at level 0, x at level 99, y at level 99) : term_scope.

(* A side of a comparison is a term, or inverse(x). *)
Coercion Fin : term >-> side.
Bind Scope term_scope with side.
Notation "'inverse' ( x )" := (Inv x) (at level 0, x at level 99) : term_scope.
Notation "x < y" := (Compare x LT y) : formula_scope.
Notation "x <= y" := (Compare x LE y) : formula_scope.
Notation "x > y" := (Compare x GT y) : formula_scope.
Notation "x >= y" := (Compare x GE y) : formula_scope.

Notation "'not' p" := (Not p) (at level 75, right associativity) : formula_scope.
Notation "p 'and' q" := (And p q) (at level 80, right associativity) : formula_scope.
Notation "p 'or' q" := (Or p q) (at level 85, right associativity) : formula_scope.
Notation "p -> q" := (Or (Not p) q) : formula_scope.

(* Without an interval it is [0, inf). *)
Notation "'F[' lo , hi ] p" := (Eventually lo (Some hi%term) p)
  (at level 75, lo at level 60, hi at level 60, p at level 75) : formula_scope.
Notation "'F[' lo , 'inf' ) p" := (Eventually lo None p) (at level 75, lo at level 60, p at level 75) : formula_scope.
Notation "'F' p" := (Eventually 0%term None p) (at level 75, right associativity) : formula_scope.
Notation "'G[' lo , hi ] p" := (Always lo (Some hi%term) p)
  (at level 75, lo at level 60, hi at level 60, p at level 75) : formula_scope.
Notation "'G[' lo , 'inf' ) p" := (Always lo None p) (at level 75, lo at level 60, p at level 75) : formula_scope.
Notation "'G' p" := (Always 0%term None p) (at level 75, right associativity) : formula_scope.
Notation "p 'U[' lo , hi ] q" := (Until p lo (Some hi%term) q)
  (at level 78, lo at level 60, hi at level 60, q at level 77) : formula_scope.
Notation "p 'U[' lo , 'inf' ) q" := (Until p lo None q) (at level 78, lo at level 60, q at level 77) : formula_scope.
Notation "p 'U' q" := (Until p 0%term None q) (at level 78, q at level 77) : formula_scope.

Notation "'some' l 'in' d , p" := (some_in d (fun l => p))
  (at level 90, l name, d at level 10, p at level 90) : formula_scope.
Notation "'every' l 'in' d , p" := (every_in d (fun l => p))
  (at level 90, l name, d at level 10, p at level 90) : formula_scope.
