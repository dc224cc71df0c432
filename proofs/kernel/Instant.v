(* Facts about one instant.  NOT TRUSTED: tactics, whose proofs Coq checks.

   A printed fact says that one of some comparisons holds at every time.  `instant_linear` unfolds what they
   mean and asks for a proof in linear arithmetic; `instant` resolves maxima, inverses and quotients by cases
   before that, and asks for one in nonlinear arithmetic (nra) too. *)
From Coq Require Import Reals QArith Qreals String List Lra Psatz Classical.
From Roadproof Require Import Meaning.
Import ListNotations.
Open Scope R_scope.

Lemma Q2R_whole z : Q2R (z # 1) = IZR z. Proof. unfold Q2R; simpl; lra. Qed.
Lemma Q2R_ratio z d : Q2R (z # d) = IZR z / IZR (Zpos d). Proof. reflexivity. Qed.

Ltac open_bounds H :=
  repeat match type of H with
         | Forall _ (_ :: _) => let B := fresh "B" in let H' := fresh "H'" in
             inversion_clear H as [|? ? B H']; cbn [keeps_to] in B; rename H' into H
         | Forall _ [] => clear H
         end.
Ltac open_fact :=
  unfold valid_always, respects;
  let W := fresh "W" in let named := fresh "named" in let t := fresh "t" in let H := fresh "H" in
  intros W named t H;
  match type of H with Forall ?p ?b => let b' := eval vm_compute in b in change (Forall p b') in H end; open_bounds H;
  match goal with |- holds ?w ?n ?u ?t ?f =>
    let f' := eval vm_compute in f in change (holds w n u t f') end;
  cbn [holds compares extended_number number place member];
  rewrite ?Q2R_whole, ?Q2R_ratio.
Ltac sizes := repeat match goal with
  | |- context [measure ?W ?n ?a] =>
      let P := fresh "P" in pose proof (measure_positive W n a) as P; revert P; generalize (measure W n a); intros ? P
  end.

(* quotients by what is not zero are numbers q with q times divisor = numerator; so are inverses *)
Ltac nonzero := first [assumption | apply not_eq_sym; assumption | lra | nra].
Ltac quotients := repeat match goal with
  | |- context [?x / ?y] =>
      lazymatch y with IZR _ => fail | _ => idtac end;
      let E := fresh "E" in
      assert (E : (x / y) * y = x) by (field; nonzero); revert E; generalize (x / y)
  | |- context [/ ?y] =>
      lazymatch y with IZR _ => fail | _ => idtac end;
      let E := fresh "E" in
      assert (E : (/ y) * y = 1) by (field; nonzero); revert E; generalize (/ y)
  end; intros.
Ltac pairs W := repeat match goal with
  | A : 0 <= parameter W ?x, B : 0 <= parameter W ?y |- _ =>
      lazymatch goal with
      | _ : 0 <= parameter W x * parameter W y |- _ => fail
      | _ : 0 <= parameter W y * parameter W x |- _ => fail
      | |- _ => let P := fresh "P" in pose proof (Rmult_le_pos _ _ A B) as P
      end
  end.
Ltac inverses := repeat match goal with |- context [Req_EM_T ?a ?b] => destruct (Req_EM_T a b) end.
Ltac bounded := repeat match goal with
  | |- context [Rmax ?a ?b] => let P := fresh "P" in let Q := fresh "Q" in
      pose proof (Rmax_l a b) as P; pose proof (Rmax_r a b) as Q; revert P Q; generalize (Rmax a b); intros ? P Q
  | |- context [Rmin ?a ?b] => let P := fresh "P" in let Q := fresh "Q" in
      pose proof (Rmin_l a b) as P; pose proof (Rmin_r a b) as Q; revert P Q; generalize (Rmin a b); intros ? P Q end.
Ltac cases := unfold Rmax, Rmin in *; repeat match goal with
  | |- context [Rle_dec ?a ?b] => destruct (Rle_dec a b) as [?L|?L]; [|apply Rnot_le_lt in L] end.
Ltac signs := repeat match goal with A : 0 < parameter ?W ?x |- _ =>
  lazymatch goal with
  | _ : 0 <= parameter W x |- _ => fail
  | |- _ => let P := fresh "P" in pose proof (Rlt_le _ _ A) as P end end.
(* the negated goal, taken apart *)
Ltac settle :=
  cbn [less at_most]; apply NNPP; intro;
  repeat match goal with
  | N : ~ (_ \/ _) |- _ => apply not_or_and in N; destruct N
  | N : ~ ~ _ |- _ => apply NNPP in N
  | N : ~ (_ /\ _) |- _ => apply not_and_or in N; destruct N
  | N : _ /\ _ |- _ => destruct N
  | N : _ \/ _ |- _ => destruct N
  | N : ~ (_ <= _) |- _ => apply Rnot_le_lt in N
  | N : ~ (_ < _) |- _ => apply Rnot_lt_le in N
  end;
  repeat match goal with
  | N : ~ True |- _ => exfalso; apply N; exact I | N : False |- _ => destruct N | N : True |- _ => clear N
  | N : ~ true = true |- _ => exfalso; apply N; reflexivity | N : false = true |- _ => discriminate N end;
  try contradiction.
Ltac finish := match goal with W : world |- _ => signs; pairs W end; first [lra | nra].
Ltac revert_quotients := repeat match goal with
  | H : context [_ / _] |- _ => revert H | H : context [/ _] |- _ => revert H end.
Ltac instant_linear := open_fact; sizes; settle; lra.
Ltac instant := open_fact; sizes;
  first
  [ solve [ bounded; inverses; settle; revert_quotients; quotients; finish ]
  | solve [ inverses; cases; settle; revert_quotients; quotients; finish ] ].
