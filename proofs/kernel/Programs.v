(* What a program is, and when values solve it.  TRUSTED: read this file.

   A question whether there is a drive within limits becomes a program: columns between bounds, products of two
   columns, equations, inequalities, and a condition made of conjunctions and disjunctions of inequalities.
   Numbers are integers; a bound is of the column times `scale`.  `Refuted.v` proves that programs have no
   solution. *)
From Coq Require Export Reals ZArith PArith List.
Export ListNotations.
Open Scope R_scope.

Definition linear := (list (positive * Z) * Z)%type.            (* coefficients by column, and the constant *)

Inductive node :=
  | Holds (strict : bool) (l : linear)                           (* above 0 where strict, else at least 0 *)
  | Every (parts : list positive)
  | Either (parts : list positive).

Record program := {
  scale : Z;
  columns : list (positive * (Z * Z));
  products : list (positive * (positive * positive));            (* this column is the product of these two *)
  equal : list (positive * linear);
  above : list (positive * linear);
  nodes : list (positive * node);
  condition : positive
}.

Fixpoint value (x : positive -> R) (terms : list (positive * Z)) : R :=
  match terms with [] => 0 | (k, c) :: terms => IZR c * x k + value x terms end.
Definition worth (x : positive -> R) (l : linear) : R := value x (fst l) + IZR (snd l).

Inductive true_at (x : positive -> R) (given : list (positive * node)) : positive -> Prop :=
  | by_value n strict l :
      In (n, Holds strict l) given -> (if strict then 0 < worth x l else 0 <= worth x l) -> true_at x given n
  | by_all n parts :
      In (n, Every parts) given -> (forall p, In p parts -> true_at x given p) -> true_at x given n
  | by_one n parts p :
      In (n, Either parts) given -> In p parts -> true_at x given p -> true_at x given n.

Definition solves (x : positive -> R) (p : program) : Prop :=
  (forall k low high, In (k, (low, high)) (columns p) ->
     IZR low <= IZR (scale p) * x k <= IZR high)
  /\ (forall k i j, In (k, (i, j)) (products p) -> x k = x i * x j)
  /\ (forall n l, In (n, l) (equal p) -> worth x l = 0)
  /\ (forall n l, In (n, l) (above p) -> 0 <= worth x l)
  /\ true_at x (nodes p) (condition p).

(* How programs are printed. *)
Definition a_column (k : positive) (low high : Z) := (k, (low, high)).
Definition a_product (k i j : positive) := (k, (i, j)).
Definition a_term (k : positive) (c : Z) := (k, c).
Definition a_row (n : positive) (terms : list (positive * Z)) (constant : Z) : positive * linear :=
  (n, (terms, constant)).
Definition a_leaf (n : positive) (strict : bool) (terms : list (positive * Z)) (constant : Z) :=
  (n, Holds strict (terms, constant)).
Definition a_conjunction (n : positive) (parts : list positive) := (n, Every parts).
Definition a_disjunction (n : positive) (parts : list positive) := (n, Either parts).
