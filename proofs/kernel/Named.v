(* Named facts.  NOT TRUSTED: tactics, whose proofs Coq checks.

   What `instant` does not find of the terms that the library speaks of: that robust predicates have the sign of
   the Boolean ones (P7), how the longitudinal RSS distance grows (P8), and its guarantee (P9, from Rss.v).
   `some_instant` tries all that there is. *)
From Coq Require Import Reals QArith Qreals String List Lra Psatz Classical.
From Roadproof Require Import Meaning Rss Instant.
Import ListNotations.
Open Scope R_scope.

Lemma inverse_agrees x D : 0 < D ->
  (at_most (Real 0) (if Req_EM_T x 0 then Infinity else Real (/ x)) /\
   at_most (if Req_EM_T D 0 then Infinity else Real (/ D)) (if Req_EM_T x 0 then Infinity else Real (/ x)))
  <-> (at_most (Real 0) (Real x) /\ at_most (Real x) (Real D)).
Proof.
  intros HD. destruct (Req_EM_T D 0); [lra|]. destruct (Req_EM_T x 0) as [->|N]; cbn [at_most].
  - split; intros; split; try exact I; lra.
  - split; intros [A B].
    + assert (0 < x). { destruct (Rlt_le_dec 0 x); [assumption|]. assert (/ x < 0) by (apply Rinv_lt_0_compat; lra). lra. }
      split; [lra|]. apply Rnot_lt_le. intros L.
      assert (/ x < / D) by (apply Rinv_lt_contravar; [apply Rmult_lt_0_compat|]; lra). lra.
    + assert (0 < x) by lra. split; [apply Rlt_le, Rinv_0_lt_compat; assumption|apply Rinv_le_contravar; lra].
Qed.
Ltac robust := open_fact;
  match goal with |- context [measure ?W ?n ?a + Rmax 0 ?X] =>
    let D := fresh "D" in
    assert (D : 0 < measure W n a + Rmax 0 X) by (pose proof (measure_positive W n a); pose proof (Rmax_l 0 X); lra);
    generalize dependent (measure W n a + Rmax 0 X); intros
  end;
  match goal with D : 0 < ?d |- context [Req_EM_T ?x 0] =>
    lazymatch x with d => fail | _ => pose proof (inverse_agrees x d D); tauto end end.

Lemma over_grows x y b : 0 < b -> 0 <= x <= y -> x ^ 2 / (2 * b) <= y ^ 2 / (2 * b).
Proof.
  intros B H. apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; lra|apply pow_incr; assumption].
Qed.
Lemma max_grows x y : x <= y -> Rmax 0 x <= Rmax 0 y.
Proof. intros. apply Rle_max_compat_l. assumption. Qed.
Ltac growth := open_fact; cbn [less at_most];
  match goal with |- context [Rmax 0 ?X <= Rmax 0 ?Y] =>
    match goal with |- context [variable ?W "u"%string <= variable ?W "v"%string] =>
      destruct (classic (0 <= variable W "u"%string /\ variable W "u"%string <= variable W "v"%string)) as [[U V]|N]; [|tauto];
      right; right; apply max_grows;
      pose proof (Rmult_le_pos (parameter W "a_max"%string) (parameter W "rho"%string) ltac:(lra) ltac:(lra));
      pose proof (over_grows (variable W "u"%string + parameter W "a_max"%string * parameter W "rho"%string)
        (variable W "v"%string + parameter W "a_max"%string * parameter W "rho"%string) (parameter W "b_min"%string) ltac:(lra) ltac:(lra));
      pose proof (Rmult_le_compat_r (parameter W "rho"%string) (variable W "u"%string) (variable W "v"%string) ltac:(lra) V);
      lra
    end end.
Ltac falls := open_fact; cbn [less at_most];
  match goal with |- context [Rmax 0 ?X <= Rmax 0 ?Y] =>
    match goal with |- context [variable ?W "u"%string <= variable ?W "v"%string] =>
      destruct (classic (0 <= variable W "u"%string /\ variable W "u"%string <= variable W "v"%string)) as [[U V]|N]; [|tauto];
      right; right; apply max_grows;
      pose proof (over_grows (variable W "u"%string) (variable W "v"%string) (parameter W "b_max"%string) ltac:(lra) ltac:(lra)); lra
    end end.
Lemma minus_as_written x y : x - y = x + -1 * y.
Proof. ring. Qed.
Ltac guarantee := open_fact; cbn [less at_most];
  match goal with |- context [parameter ?W "b_min"%string <= parameter ?W "b_max"%string] =>
    pose proof (envelopes (parameter W "a_max"%string) (parameter W "b_max"%string) (parameter W "b_min"%string) (parameter W "rho"%string)
      ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)) as G;
    specialize (fun H => G H (variable W "v_r"%string) (variable W "v_f"%string) (variable W "gap"%string) (variable W "t"%string));
    unfold dRSS, front, rear, braking in G;
    rewrite !minus_as_written in G;
    tauto
  end.

Ltac some_instant := first
  [ solve [instant_linear] | solve [robust] | solve [growth] | solve [falls] | solve [guarantee] | solve [instant] ].
