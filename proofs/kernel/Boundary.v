(* The boundaries of driver models.  NOT TRUSTED: proved.

   For each driver in a cut-in or cut-out, that the formula of driver.spec, over numbers, is true of a state if and
   only if the motion that Prescribed.v says leads to a collision from there. *)
From Coq Require Import Reals QArith Qreals String List Lra Psatz.
From Roadproof Require Import Meaning Prescribed Braking Gained.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Lemma never_passed (x p : R -> R) g y :
  (forall t, 0 <= t <= y -> x t - p t <= g) <-> ~ exists t, 0 <= t <= y /\ x t - p t > g.
Proof.
  split; [intros N [t [L G]]; pose proof (N t L); lra|]. intros N t L. apply Rnot_lt_le. intros G. apply N. exists t. split; [exact L|lra].
Qed.

Section Brakes.
  Variables v q T A : R.
  Hypotheses (Hv : 0 <= v) (Hq : 0 <= q) (HT : 0 <= T) (HA : 0 < A).
  Lemma collides_right x w g r y : brakes_from v (Some q) T A x -> 0 <= w -> 0 <= y -> 0 <= g -> 0 <= r ->
    (collide x (fun t => w * t) g r y <-> hits v w g r q y 1 T A).
  Proof.
    intros B Hw Hy Hg Hr. destruct (brakes_right v q T A Hq HT HA x B) as [X0 X]. unfold collide, hits.
    rewrite <- (ever v q T A Hv Hq HT HA x X0 X w Hw g y Hy).
    rewrite <- (ever_until v q T A Hv Hq HT HA x X0 X w Hw (g + r) y ltac:(lra) Hy). rewrite never_passed. reflexivity.
  Qed.
End Brakes.

Lemma over_positive z w : 0 <= z -> 0 < w -> 0 <= z / w.
Proof. intros. apply Rmult_le_pos; [lra|left; apply Rinv_0_lt_compat; lra]. Qed.
Lemma times_over z w : 0 < w -> w * (z / w) = z.
Proof. intros. field. lra. Qed.

Lemma hits_over v u g r q y w T A : 0 < w -> (hits v u g r q y w T A <-> hits v u g r (q / w) (y / w) 1 T A).
Proof.
  intros P. rewrite <- (times_over q w P), <- (times_over y w P) at 1. unfold hits, hasEverGained.
  rewrite !scale_gained, !scale_faster, !scale_gains by exact P. reflexivity.
Qed.
Lemma brakes_collide v u g r q y w T A : 0 <= v -> 0 <= u -> 0 <= g -> 0 <= r -> 0 <= q -> 0 <= y -> 0 < w -> 0 <= T -> 0 < A ->
  ((exists x, brakes_from v (Some (q / w)) T A x /\ collide x (fun t => u * t) g r (y / w)) <-> hits v u g r q y w T A).
Proof.
  intros Hv Hu Hg Hr Hq Hy Hw HT HA. rewrite hits_over by exact Hw.
  pose proof (over_positive q w Hq Hw) as Q. pose proof (over_positive y w Hy Hw) as Y. split.
  - intros [x [B C]]. apply (collides_right v (q / w) T A Hv Q HT HA x) in C; auto.
  - intros H. destruct (brakes_exists v (q / w) T A Hv Q HT HA) as [x B]. exists x. split; [exact B|].
    apply (collides_right v (q / w) T A Hv Q HT HA x); auto.
Qed.

(* the first instant at which it has gone z across at w *)
Lemma reaches z w o : 0 <= z -> 0 < w -> (first (fun t => z <= w * t) 0 o <-> o = Some (z / w)).
Proof.
  intros Z P. pose proof (over_positive z w Z P) as Q. pose proof (times_over z w P) as E. set (e := z / w) in *. split.
  - destruct o as [t|]; cbn [first]; [intros [T [H N]]|intros N; exfalso; apply (N e); lra].
    f_equal. destruct (Rtotal_order t e) as [L|[L|L]]; [|exact L|].
    + exfalso. nra.
    + exfalso. apply (N e); lra.
  - intros ->. cbn [first]. repeat split; [exact Q|lra|]. intros u [U1 U2] H. nra.
Qed.

Section Cut_in.
  Variables (W : world) (now : R) (a b : vehicle).
  Hypotheses (Ha : 0 <= speed W now a) (Hb : 0 <= speed W now b).

  Definition from_side (H : R -> R -> Prop) y w : Prop := (0 < w /\ 0 <= y /\ 0 <= gap W now a b) /\ H y w.
  Definition from_both H : Prop :=
    from_side H (beside W now a b) (-1 * value W Speed_lat b now) \/ from_side H (beside W now b a) (value W Speed_lat b now).

  Lemma lengths_positive : 0 <= lengths W a b.
  Proof. unfold lengths. pose proof (measure_positive W Length a). pose proof (measure_positive W Length b). lra. Qed.

  Lemma from_both_right driver H :
    (forall y w, 0 < w -> 0 <= y -> 0 <= gap W now a b ->
      (H y w <-> exists x, driver y w x /\ collide x (fun t => speed W now b * t) (gap W now a b) (lengths W a b) (y / w))) ->
    (from_both H <-> cut_in W now driver a b).
  Proof.
    intros E.
    assert (S : forall y w, from_side H y w <-> comes_in W now driver a b y w).
    { intros y w. unfold from_side, comes_in. split.
      - intros [[P1 [P2 P3]] Q]. repeat split; try lra. apply E; assumption.
      - intros [P1 [P2 [P3 Q]]]. repeat split; try lra. apply E; try lra. exact Q. }
    unfold from_both, cut_in. replace (- value W Speed_lat b now) with (-1 * value W Speed_lat b now) by ring.
    rewrite !S. reflexivity.
  Qed.

  Definition intrusion_hits delay A y w : Prop :=
    hits (speed W now a) (speed W now b) (gap W now a b) (lengths W a b)
      (y / 2 + parameter W "r157_past" + delay * w) y w 0 A.
  Theorem intrusion_boundary delay A : 0 <= parameter W "r157_past" -> 0 <= delay -> 0 < A ->
    (from_both (intrusion_hits delay A) <-> cut_in W now (after_intrusion W delay A (speed W now a)) a b).
  Proof.
    intros Hp Hd HA. apply from_both_right. intros y w Hw Hy Hg. unfold intrusion_hits.
    assert (D : 0 <= delay * w) by (apply Rmult_le_pos; lra).
    rewrite <- (brakes_collide _ _ _ _ _ _ _ 0 A Ha Hb Hg lengths_positive) by lra.
    replace ((y / 2 + parameter W "r157_past" + delay * w) / w) with ((y / 2 + parameter W "r157_past") / w + delay) by (field; lra).
    unfold after_intrusion. split.
    - intros [x [B C]]. exists x. split; [|exact C]. exists (Some ((y / 2 + parameter W "r157_past") / w)).
      split; [|exact B]. apply reaches; [unfold par; lra|exact Hw|reflexivity].
    - intros [x [[s [F B]] C]]. exists x. split; [|exact C]. apply reaches in F; [|unfold par; lra|exact Hw]. subst s. exact B.
  Qed.

  Theorem r157_boundary : 0 < parameter W "r157_braking" -> 0 <= parameter W "r157_delay" -> 0 <= parameter W "r157_past" ->
    (from_both (intrusion_hits (parameter W "r157_delay") (parameter W "r157_braking")) <-> cut_in W now (r157 W now a) a b).
  Proof. intros. apply intrusion_boundary; assumption. Qed.
  Theorem eu1426_boundary : 0 < parameter W "eu1426_braking" -> 0 <= parameter W "eu1426_delay" ->
    0 <= parameter W "eu1426_ramp" -> 0 <= parameter W "r157_past" ->
    (from_both (intrusion_hits (parameter W "eu1426_delay" + parameter W "eu1426_ramp" / 2) (parameter W "eu1426_braking"))
     <-> cut_in W now (eu1426 W now a) a b).
  Proof. intros. apply intrusion_boundary; [assumption|lra|assumption]. Qed.

  (* --- the competent and careful driver ---------------------------------------------------------------- *)
  Notation v := (speed W now a).
  Notation u := (speed W now b).
  Notation g := (gap W now a b).
  Notation both_lengths := (lengths W a b).
  Notation par := (parameter W).
  Definition seen (p : perception) (y : R) : R :=
    match p with by_time => par "cc_wander" | by_distance => par "cc_wander" + par "cc_drift" | by_overlap => y end.
  Definition weighed (p : perception) (w : R) : R :=
    match p with by_time => par "cc_evaluation" * w | _ => 0 * w * 1 end.
  Definition hit_by_careful y q w : Prop := hits v u g both_lengths q y w (par "cc_ramp") (par "cc_braking").
  Definition ungated p y w : Prop := hit_by_careful y (seen p y + weighed p w + par "cc_delay" * w) w.
  Definition gated y w p x : Prop :=
    u < v /\ ((w * (g - par "cc_ttc" * (v - u)) <= p * (v - u) /\ hit_by_careful y (p + x) w)
      \/ (p * (v - u) < w * (g - par "cc_ttc" * (v - u))
          /\ hit_by_careful (y * (v - u)) (w * (g - par "cc_ttc" * (v - u)) + x * (v - u)) (w * (v - u)))).
  Definition careful_hits p (k : gate) y w : Prop :=
    match k with
    | no_gate => ungated p y w
    | before_perception => gated y w (seen p y) (weighed p w + par "cc_delay" * w)
    | before_delay => gated y w (seen p y + weighed p w) (par "cc_delay" * w)
    end.

  (* first P from s on, where P is so from e on *)
  Lemma first_of P Q s e o : (forall t, s <= t -> (P t <-> e <= t)) -> s <= e ->
    (first (fun t => P t /\ Q t) s o <-> first Q e o).
  Proof.
    intros E L. destruct o as [t|]; cbn [first]; split.
    - intros [S [[P1 Q1] N]]. apply E in P1; [|exact S]. repeat split; [exact P1|exact Q1|].
      intros z Z Qz. apply (N z); [lra|]. split; [apply E; lra|exact Qz].
    - intros [S [Q1 N]]. repeat split; [lra|apply E; lra|exact Q1|].
      intros z Z [Pz Qz]. apply E in Pz; [|lra]. apply (N z); [lra|exact Qz].
    - intros N t T Qt. apply (N t); [lra|]. split; [apply E; lra|exact Qt].
    - intros N t T [Pt Qt]. apply E in Pt; [|exact T]. apply (N t); assumption.
  Qed.
  (* the first instant from s on at which the gate is open *)
  Lemma opens s o : u < v ->
    (first (close W now a b) s o <-> o = Some (Rmax s ((g - par "cc_ttc" * (v - u)) / (v - u)))).
  Proof.
    intros V. set (e := (g - par "cc_ttc" * (v - u)) / (v - u)).
    assert (E : forall t, close W now a b t <-> e <= t).
    { intros t. unfold close, Prescribed.par. assert (Ee : (v - u) * e = g - par "cc_ttc" * (v - u)) by (unfold e; field; lra).
      split; intros H; nra. }
    split.
    - destruct o as [t|]; cbn [first].
      + intros [S [C N]]. apply E in C. f_equal. apply Rle_antisym; [|apply Rmax_lub; assumption].
        apply Rnot_lt_le. intros M. apply (N (Rmax s e)); [split; [apply Rmax_l|exact M]|]. apply E, Rmax_r.
      + intros N. exfalso. apply (N (Rmax s e)); [apply Rmax_l|apply E, Rmax_r].
    - intros ->. cbn [first]. repeat split; [apply Rmax_l|apply E, Rmax_r|].
      intros z [Z1 Z2] C. apply E in C. apply (Rlt_irrefl z). apply Rlt_le_trans with (Rmax s e); [exact Z2|].
      apply Rmax_lub; assumption.
  Qed.

  Hypotheses (H_ramp : 0 < par "cc_ramp") (H_braking : 0 < par "cc_braking") (H_delay : 0 <= par "cc_delay").
  (* of the parameters of a reading *)
  Definition known (p : perception) : Prop :=
    match p with
    | by_time => 0 < par "cc_wander" /\ 0 <= par "cc_evaluation"
    | by_distance => 0 < par "cc_wander" /\ 0 <= par "cc_drift"
    | by_overlap => True
    end.

  Lemma hit_by_careful_right y q w o : 0 <= g -> 0 <= y -> 0 <= q -> 0 < w -> o = q / w ->
    (hit_by_careful y q w <-> exists x, brakes_from v (Some o) (par "cc_ramp") (par "cc_braking") x
      /\ collide x (fun t => u * t) g both_lengths (y / w)).
  Proof.
    intros Hg Hy Hq Hw ->. unfold hit_by_careful. symmetry. apply brakes_collide; try assumption; [apply lengths_positive|lra].
  Qed.
  (* who is not faster hits nobody ahead *)
  Lemma not_faster o x y : 0 <= g -> v <= u -> 0 <= y -> match o with Some q => 0 <= q | None => True end ->
    brakes_from v o (par "cc_ramp") (par "cc_braking") x -> ~ collide x (fun t => u * t) g both_lengths y.
  Proof.
    intros Hg V Hy Ho B [_ [t [T C]]]. destruct o as [q|].
    - destruct (brakes_right v q (par "cc_ramp") (par "cc_braking") Ho ltac:(lra) H_braking x B) as [X0 X].
      assert (x t - u * t <= x 0 - u * 0); [|lra].
      apply (falls (fun t => x t - u * t) (fun t => speed_at v q (par "cc_ramp") (par "cc_braking") t - u * 1)); [lra| |].
      + intros z Z. apply (gained_slope v q (par "cc_ramp") (par "cc_braking") x X). lra.
      + intros z Z. pose proof (never_faster v q (par "cc_ramp") (par "cc_braking") H_braking u Hb z V). lra.
    - rewrite (constant_way v x B t) in C by lra. nra.
  Qed.

  Lemma seen_positive p y : known p -> 0 <= y -> 0 <= seen p y.
  Proof. destruct p; cbn [known seen]; intros; lra. Qed.
  Lemma evaluation_positive p : known p -> 0 <= evaluation W p.
  Proof. destruct p; cbn [known evaluation]; unfold Prescribed.par; intros; lra. Qed.
  Lemma weighed_is p w : weighed p w = evaluation W p * w.
  Proof. destruct p; cbn [weighed evaluation]; unfold Prescribed.par; ring. Qed.
  Lemma perceived_is p y w t : perceived W p y w t <-> seen p y <= w * t.
  Proof. destruct p; reflexivity. Qed.
  Lemma first_perceived p y w o : known p -> 0 <= y -> 0 < w ->
    (first (perceived W p y w) 0 o <-> o = Some (seen p y / w)).
  Proof.
    intros K Y P. rewrite <- (reaches (seen p y) w o (seen_positive p y K Y) P).
    destruct o; cbn [first]; destruct p; reflexivity.
  Qed.

  (* the instant at which braking begins, by readings of the gate *)
  Lemma onset_ungated p y w o : known p -> 0 < w -> 0 <= y ->
    (onset W now p no_gate a b y w o <-> o = Some (seen p y / w + (evaluation W p + par "cc_delay"))).
  Proof.
    intros K P Y. cbn [onset]. split.
    - intros [s [F ->]]. apply first_perceived in F; auto. subst s. reflexivity.
    - intros ->. eexists. split; [apply first_perceived; auto|reflexivity].
  Qed.
  Lemma onset_before_perception p y w o : known p -> 0 < w -> 0 <= y ->
    (onset W now p before_perception a b y w o
     <-> exists d, first (close W now a b) (seen p y / w) d /\ o = later (evaluation W p + par "cc_delay") d).
  Proof.
    intros K P Y. pose proof (over_positive (seen p y) w (seen_positive p y K Y) P) as S.
    cbn [onset]. split; intros [s [F ->]]; exists s; (split; [|reflexivity]);
      apply (first_of (perceived W p y w) (close W now a b) 0 (seen p y / w) s); auto; intros t T; rewrite perceived_is;
      pose proof (times_over (seen p y) w P); set (z := seen p y / w) in *; split; intros; nra.
  Qed.
  Lemma onset_before_delay p y w o : known p -> 0 < w -> 0 <= y ->
    (onset W now p before_delay a b y w o
     <-> exists d, first (close W now a b) ((seen p y + evaluation W p * w) / w) d /\ o = later (par "cc_delay") d).
  Proof.
    intros K P Y. replace ((seen p y + evaluation W p * w) / w) with (seen p y / w + evaluation W p) by (field; lra).
    cbn [onset]. split.
    - intros [s [d [F [D ->]]]]. apply first_perceived in F; auto. injection F as ->. exists d. split; [exact D|reflexivity].
    - intros [d [D ->]]. exists (seen p y / w), d. split; [apply first_perceived; auto|]. split; [exact D|reflexivity].
  Qed.

  Lemma ungated_right p y w : known p -> 0 < w -> 0 <= y -> 0 <= g ->
    (ungated p y w <-> exists x, careful W now p no_gate a b y w x /\ collide x (fun t => u * t) g both_lengths (y / w)).
  Proof.
    intros K P Y G. unfold ungated. pose proof (seen_positive p y K Y) as S. pose proof (evaluation_positive p K) as E.
    assert (E' : 0 <= evaluation W p * w) by (apply Rmult_le_pos; lra).
    assert (D' : 0 <= par "cc_delay" * w) by (apply Rmult_le_pos; lra). rewrite weighed_is.
    rewrite (hit_by_careful_right y _ w (seen p y / w + (evaluation W p + par "cc_delay"))) by (try lra; field; lra).
    unfold careful. split.
    - intros [x [B C]]. exists x. split; [|exact C]. eexists. split; [apply onset_ungated; auto|exact B].
    - intros [x [[o [O B]] C]]. exists x. split; [|exact C]. apply onset_ungated in O; auto. subst o. exact B.
  Qed.

  (* Braking begins x/w after the gate is open, which counts from p/w on; `goes_ o` is how a goes where it begins at o,
     and `hit c` whether it hits b, over times as fractions of w * c. *)
  Lemma gate_right (goes_ : option R -> (R -> R) -> Prop) (hit : R -> R -> Prop) (begins : option R -> Prop) y w p x e :
    0 < w -> 0 <= p -> 0 <= x -> x = e * w ->
    (v <= u -> forall o z, begins o -> goes_ o z -> ~ collide z (fun t => u * t) g both_lengths (y / w)) ->
    (u < v -> forall c q o, 0 < c -> 0 <= q -> o = q / (w * c) ->
      (hit c q <-> exists z, goes_ (Some o) z /\ collide z (fun t => u * t) g both_lengths (y / w))) ->
    (u < v -> forall o, begins o <-> exists d, first (close W now a b) (p / w) d /\ o = later e d) ->
    (u < v /\ ((w * (g - par "cc_ttc" * (v - u)) <= p * (v - u) /\ hit 1 (p + x))
       \/ (p * (v - u) < w * (g - par "cc_ttc" * (v - u)) /\ hit (v - u) (w * (g - par "cc_ttc" * (v - u)) + x * (v - u))))
     <-> exists z, (exists o, begins o /\ goes_ o z) /\ collide z (fun t => u * t) g both_lengths (y / w)).
  Proof.
    intros P Hp Hx Ex N H B. destruct (Rle_lt_dec v u) as [V|V].
    { split; [intros [M _]; lra|]. intros [z [[o [Bo Gz]] C]]. exfalso. exact (N V o z Bo Gz C). }
    specialize (B V). specialize (H V). set (left_ := g - par "cc_ttc" * (v - u)) in *.
    set (o := Rmax (p / w) (left_ / (v - u)) + e).
    assert (Q : (exists z, (exists o, begins o /\ goes_ o z) /\ collide z (fun t => u * t) g both_lengths (y / w))
      <-> (exists z, goes_ (Some o) z /\ collide z (fun t => u * t) g both_lengths (y / w))).
    { split.
      - intros [z [[o' [Bo Gz]] C]]. exists z. split; [|exact C]. apply B in Bo. destruct Bo as [d [F ->]].
        apply (opens (p / w) d V) in F. subst d. exact Gz.
      - intros [z [Gz C]]. exists z. split; [|exact C]. eexists. split; [|exact Gz]. apply B.
        eexists. split; [apply (opens (p / w) _ V); reflexivity|reflexivity]. }
    rewrite Q. clear Q.
    assert (E1 : w * (v - u) * (left_ / (v - u)) = w * left_) by (field; lra).
    assert (E2 : w * (v - u) * (p / w) = p * (v - u)) by (field; lra).
    assert (W' : 0 < w * (v - u)) by (apply Rmult_lt_0_compat; lra).
    destruct (Rle_lt_dec (w * left_) (p * (v - u))) as [L|L].
    - rewrite <- (H 1 (p + x) o); [|lra|lra|].
      + split; [intros [_ [[_ K]|[K _]]]; [exact K|lra]|]. intros K. split; [exact V|left; split; assumption].
      + unfold o. rewrite Rmax_left by (apply Rmult_le_reg_l with (w * (v - u)); lra). rewrite Ex. field. lra.
    - assert (N1 : 0 <= x * (v - u)) by (apply Rmult_le_pos; lra). assert (N2 : 0 <= p * (v - u)) by (apply Rmult_le_pos; lra).
      rewrite <- (H (v - u) (w * left_ + x * (v - u)) o); [|lra|lra|].
      + split; [intros [_ [[K _]|[_ K]]]; [lra|exact K]|]. intros K. split; [exact V|right; split; assumption].
      + unfold o. rewrite Rmax_right by (apply Rmult_le_reg_l with (w * (v - u)); lra). rewrite Ex. field. lra.
  Qed.
  Lemma gated_right y w p x e (begins : option R -> Prop) : 0 < w -> 0 <= y -> 0 <= g -> 0 <= p -> 0 <= x -> x = e * w ->
    (forall o, begins o -> match o with Some q => 0 <= q | None => True end) ->
    (u < v -> forall o, begins o <-> exists d, first (close W now a b) (p / w) d /\ o = later e d) ->
    (gated y w p x <-> exists z, (exists o, begins o /\ brakes_from v o (par "cc_ramp") (par "cc_braking") z)
       /\ collide z (fun t => u * t) g both_lengths (y / w)).
  Proof.
    intros P Y G Hp Hx Ex B0 B. unfold gated.
    refine (iff_trans _ (gate_right (fun o => brakes_from v o (par "cc_ramp") (par "cc_braking"))
      (fun c q => hit_by_careful (y * c) q (w * c)) begins y w p x e P Hp Hx Ex _ _ B)).
    - rewrite !Rmult_1_r. reflexivity.
    - intros V o z Bo Bz. exact (not_faster o z (y / w) G V (over_positive y w Y P) (B0 o Bo) Bz).
    - intros V c q o Hc Hq Eo. replace (y / w) with (y * c / (w * c)) by (field; lra).
      apply hit_by_careful_right; try assumption; [apply Rmult_le_pos; lra|apply Rmult_lt_0_compat; lra].
  Qed.

  Theorem careful_boundary p k : known p -> (from_both (careful_hits p k) <-> cut_in W now (careful W now p k a b) a b).
  Proof.
    intros K. apply from_both_right. intros y w P Y G.
    pose proof (seen_positive p y K Y) as S. pose proof (evaluation_positive p K) as E.
    assert (E' : 0 <= evaluation W p * w) by (apply Rmult_le_pos; lra).
    assert (D' : 0 <= par "cc_delay" * w) by (apply Rmult_le_pos; lra).
    pose proof (over_positive (seen p y) w S P) as S'.
    destruct k; cbn [careful_hits]; unfold careful.
    - apply ungated_right; assumption.
    - apply (gated_right y w (seen p y) _ (evaluation W p + par "cc_delay") (fun o => onset W now p before_perception a b y w o));
        try assumption; [rewrite weighed_is; lra|rewrite weighed_is; ring| |intros _ o; apply onset_before_perception; assumption].
      intros o [s [F ->]]. destruct s as [s|]; cbn [later option_map]; [|exact I]. destruct F as [F _]. unfold Prescribed.par. lra.
    - rewrite weighed_is.
      apply (gated_right y w _ _ (par "cc_delay") (fun o => onset W now p before_delay a b y w o));
        try assumption; [lra|ring| |intros _ o; apply onset_before_delay; assumption].
      intros o [s [d [F [D ->]]]]. destruct d as [d|]; cbn [later option_map]; [|exact I].
      destruct F as [F _]. destruct D as [D _]. unfold Prescribed.par. lra.
  Qed.
  (* Without AEB the formula says so at its end. *)
  Definition unaided p k y w : Prop := careful_hits p k y w /\ true = true.
  Theorem unaided_boundary p k : known p -> (from_both (unaided p k) <-> cut_in W now (careful W now p k a b) a b).
  Proof. intros K. rewrite <- (careful_boundary p k K). unfold from_both, from_side, unaided. tauto. Qed.
End Cut_in.

Section Cut_out.
  Variables (W : world) (now : R) (a b c : vehicle).
  Notation par := (parameter W).
  Notation across x := (value W Speed_lat x now).
  Notation left x := (value W Place_lat x now).
  Definition lies_in_way a b : Prop := left b - measure W Width b <= left a /\ left a - measure W Width a <= left b.
  Definition hit_behind w : Prop :=
    gains (speed W now a) (speed W now c) (gap W now a c) (par "cc_wander" + (par "cc_evaluation" + par "cc_delay") * w) w
      (par "cc_ramp") (par "cc_braking").
  Definition cut_out_hits : Prop :=
    ((across b < 0 \/ 0 < across b) /\ lies_in_way a b /\ lies_in_way a c /\ 0 <= gap W now a b /\ 0 <= gap W now b c
      /\ speed W now c <= speed W now a)
    /\ ((0 < across b /\ hit_behind (across b)) \/ (0 < -1 * across b /\ hit_behind (-1 * across b))).

  Lemma hit_behind_right w : 0 <= speed W now a -> 0 <= speed W now c -> 0 < par "cc_ramp" -> 0 < par "cc_braking" ->
    0 < par "cc_wander" -> 0 <= par "cc_evaluation" -> 0 <= par "cc_delay" -> 0 <= gap W now a c -> 0 < w ->
    (hit_behind w <-> exists x, careful_behind W now a w x
       /\ collide x (fun t => speed W now c * t) (gap W now a c) (lengths W a c) 0).
  Proof.
    intros Ha Hc HT HA Hw He Hd Hg P. unfold hit_behind.
    set (q := par "cc_wander" / w + (par "cc_evaluation" + par "cc_delay")).
    assert (Z : 0 <= par "cc_wander" / w) by (apply over_positive; lra).
    assert (Q : 0 <= q) by (unfold q; lra).
    replace (par "cc_wander" + (par "cc_evaluation" + par "cc_delay") * w) with (w * q) by (unfold q; field; lra).
    rewrite scale_gains by exact P.
    assert (E : forall x, careful_behind W now a w x <-> brakes_from (speed W now a) (Some q) (par "cc_ramp") (par "cc_braking") x).
    { intros x. unfold careful_behind. split.
      - intros [s [F B]]. apply (reaches (par "cc_wander") w s ltac:(lra) P) in F. subst s. exact B.
      - intros B. exists (Some (par "cc_wander" / w)). split; [|exact B]. apply (reaches (par "cc_wander") w _ ltac:(lra) P). reflexivity. }
    pose proof (measure_positive W Length a). pose proof (measure_positive W Length c).
    assert (C : forall x, brakes_from (speed W now a) (Some q) (par "cc_ramp") (par "cc_braking") x ->
      (collide x (fun t => speed W now c * t) (gap W now a c) (lengths W a c) 0
       <-> gains (speed W now a) (speed W now c) (gap W now a c) q 1 (par "cc_ramp") (par "cc_braking"))).
    { intros x B. destruct (brakes_right (speed W now a) q _ _ Q (Rlt_le _ _ HT) HA x B) as [X0 X].
      rewrite <- (ever_from_0 _ q _ _ Ha Q (Rlt_le _ _ HT) HA x X0 X _ Hc _ Hg). unfold collide, lengths.
      split; [intros [_ H']; exact H'|intros H'; split; [|exact H']].
      intros t Ht. replace t with 0 by lra. rewrite X0. lra. }
    split.
    - intros G. destruct (brakes_exists (speed W now a) q (par "cc_ramp") (par "cc_braking") Ha Q ltac:(lra) HA) as [x B].
      exists x. split; [apply E; exact B|apply C; assumption].
    - intros [x [B H']]. apply E in B. apply C in H'; assumption.
  Qed.
  Theorem cut_out_boundary : 0 <= speed W now a -> 0 <= speed W now c -> 0 < par "cc_braking" -> 0 <= par "cc_delay" ->
    0 <= par "cc_evaluation" -> 0 < par "cc_ramp" -> 0 < par "cc_wander" ->
    (cut_out_hits <-> cut_out W now (careful_behind W now a) a b c).
  Proof.
    intros Ha Hc HA Hd He HT Hw. unfold cut_out_hits, cut_out, lies_in_way, in_way, beside.
    pose proof (measure_positive W Length b) as Lb.
    assert (R : forall w, 0 < w -> 0 <= gap W now a b -> 0 <= gap W now b c ->
      (hit_behind w <-> exists x, careful_behind W now a w x
         /\ collide x (fun t => speed W now c * t) (gap W now a c) (lengths W a c) 0)).
    { intros w P G1 G2. apply hit_behind_right; auto. unfold gap in *. lra. }
    split.
    - intros [[N [[I1 I2] [[I3 I4] [G1 [G2 S]]]]] H].
      destruct H as [[P H]|[P H]]; [rewrite Rabs_right by lra|rewrite Rabs_left by lra; replace (- across b) with (-1 * across b) by ring];
        (repeat split; try lra); apply (R _ P G1 G2); exact H.
    - intros [N [[I1 I2] [[I3 I4] [G1 [G2 [S H]]]]]].
      assert (N' : across b < 0 \/ 0 < across b).
      { destruct (Rtotal_order (across b) 0) as [L|[L|L]]; [left; exact L| |right; lra]. exfalso. apply N. rewrite L. apply Rabs_R0. }
      split; [repeat split; try lra; exact N'|].
      destruct N' as [L|L]; [right; rewrite Rabs_left in H by lra|left; rewrite Rabs_right in H by lra].
      + replace (- across b) with (-1 * across b) in H by ring. split; [lra|apply R; try lra; exact H].
      + split; [lra|apply R; try lra; exact H].
  Qed.
End Cut_out.
