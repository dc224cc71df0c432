(* Printed formulas of driver models as statements about numbers.  NOT TRUSTED: proved.

   `says` is `holds` for formulas about one instant, with numbers as the theories of boundaries write them.  The
   tactic `reads` shows that a printed formula is one that a theorem there is about. *)
From Coq Require Import Reals QArith Qreals String List.
From Roadproof Require Import Meaning Prescribed Gained Boundary Braked Following Responding Joined Assisted Aeb.
From Roadproof Require Text.
Import ListNotations.
Open Scope R_scope.

Section Says.
  Variables (W : world) (named : string -> element W) (bound : nat -> element W) (t : R).
  Fixpoint told (x : term) : R :=
    match x with
    | Num (Qmake z 1) => IZR z
    | Add x (Mul (Num (Qmake (-1) 1)) y) => told x - told y
    | Add x y => told x + told y
    | Mul x y => told x * told y
    | Pow x n => pow (told x) n
    | Div x (Num (Qmake 1 1)) => told x
    | Div x y => told x / told y
    | Max x y => Rmax (told x) (told y)
    | Min x y => Rmin (told x) (told y)
    | x => number W t x
    end.
  Fixpoint says (f : formula) : Prop :=
    match f with
    | Truth b => b = true
    | Compare (Fin l) LT (Fin r) => told l < told r
    | Compare (Fin l) LE (Fin r) => told l <= told r
    | Compare (Fin l) GT (Fin r) => told r < told l
    | Compare (Fin l) GE (Fin r) => told r <= told l
    | Not f => ~ says f
    | And f g => says f /\ says g
    | Or f g => says f \/ says g
    | f => holds W named bound t f
    end.
  Lemma whole_told z : Q2R (z # 1) = IZR z.
  Proof. unfold Q2R. cbn [Qnum Qden]. field. Qed.
  Lemma told_right x : number W t x = told x.
  Proof.
    induction x as [[z [p|p|]]| | | | |x IHx y IHy|x IHx y IHy|x IHx n|x IHx y IHy|x IHx y IHy|x IHx y IHy]; cbn [number];
      try reflexivity; try (cbn [told]; rewrite ?IHx, ?IHy; reflexivity).
    - apply whole_told.
    - rewrite IHx, IHy. cbn [told].
      destruct y as [| | | | | |[[[|z|[z|z|]] [p|p|]]| | | | | | | | | |] y| | | |]; try reflexivity.
      cbn [told]. ring.
    - rewrite IHx, IHy. cbn [told]. destruct y as [[[|[z|z|]|z] [p|p|]]| | | | | | | | | |]; try reflexivity.
      cbn [told]. field.
  Qed.
  Lemma says_right f : holds W named bound t f <-> says f.
  Proof.
    induction f; try reflexivity; cbn [holds says]; try (rewrite ?IHf, ?IHf1, ?IHf2; reflexivity).
    destruct l as [l|l], o, r as [r|r]; try reflexivity; cbn [compares extended_number less at_most]; rewrite !told_right; reflexivity.
  Qed.
End Says.
(* what is known of parameters, one by one *)
Ltac bounds_in H :=
  lazymatch type of H with
  | Forall _ (_ :: _) => let B := fresh "B" in apply Forall_cons_iff in H; destruct H as [B H];
      cbv beta iota delta [keeps_to] in B; bounds_in H
  | _ => idtac
  end.
(* The formula, of which the printed definitions are unfolded, is that of a theorem above. *)
Ltac reads :=
  eapply iff_trans; [apply says_right|];
  cbv beta iota zeta delta [
    says told number Text.whole Text.s Text.d Text.v_lon Text.v_lat Text.a_lon Text.a_lat Text.length Text.width
    from_both from_side intrusion_hits hits hasEverGained hasGained gains gainsByRamp stillFaster
    unaided careful_hits ungated gated seen weighed hit_by_careful cut_out_hits lies_in_way hit_behind
    standsLater meetsInFull meetsInRamp gainsSome gainsInRamp gainsBraking
    ahead following_hits notices rss_hits rss_following_hits
    aided_hits aidedLate aidedGated aidedHits aidedGains wrap gainsFrom isFaster gainsOver gainsOnce gainsAdded faster farther
    speed gap lengths beside par];
  exact (iff_refl _).
