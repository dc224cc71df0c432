(* Facts that are proved once, by name.  NOT TRUSTED: proved.

   `is_known` compares a fact with those that have a theorem here, where the search for products finds nothing:
   the longitudinal RSS guarantee (P9).  So the extracted program needs no tactics for them. *)
From Coq Require Import QArith String List Bool.
From Roadproof Require Import Meaning Text Tableau Named.
Import ListNotations.
Open Scope string_scope.
Open Scope nat_scope.
Open Scope term_scope.
Open Scope formula_scope.

Definition a_max := Par "a_max".
Definition b_max := Par "b_max".
Definition b_min := Par "b_min".
Definition rho := Par "rho".
Definition v_r := Var "v_r".
Definition v_f := Var "v_f".
Definition gap := Var "gap".
Definition t := Var "t".
Definition guarantee_bounds : list bound := [at_least_0 "a_max"; above_0 "b_max"; above_0 "b_min"; at_least_0 "rho"].
Definition guarantee : formula :=
  b_min <= b_max ->
  ((0 <= v_r) and (0 <= v_f) and (0 <= t) and
    (gap > max(0, v_r * rho + a_max * (rho^2) / 2 + (v_r + a_max * rho)^2 / (2 * b_min) - v_f^2 / (2 * b_max)))) ->
  (gap + (v_f * min(t, v_f / b_max) - b_max * (min(t, v_f / b_max)^2) / 2)
     - (v_r * min(t, rho) + a_max * (min(t, rho)^2) / 2
        + ((v_r + a_max * rho) * min(max(0, t - rho), (v_r + a_max * rho) / b_min)
           - b_min * (min(max(0, t - rho), (v_r + a_max * rho) / b_min)^2) / 2)) > 0).

Lemma guarantee_holds : valid_always guarantee_bounds guarantee.
Proof. Named.guarantee. Qed.

Lemma bound_dec (x y : bound) : {x = y} + {x <> y}.
Proof. decide equality; solve [apply string_dec|apply Q_dec]. Defined.
Definition among (bounds : list bound) (b : bound) : bool := if in_dec bound_dec b bounds then true else false.
Definition is_known (bounds : list bound) (f : formula) : bool :=
  same f guarantee && forallb (among bounds) guarantee_bounds.

Theorem known bounds f : is_known bounds f = true -> valid_always bounds f.
Proof.
  unfold is_known. intros H. apply andb_prop in H as [E B]. apply same_eq in E as ->.
  intros W named u R. apply guarantee_holds. unfold respects in *. rewrite Forall_forall in *. intros b I.
  apply R. rewrite forallb_forall in B. specialize (B b I). unfold among in B.
  destruct (in_dec bound_dec b bounds); [assumption|discriminate].
Qed.
