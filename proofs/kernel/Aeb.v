(* The boundaries of the competent and careful driver with AEB.  NOT TRUSTED: proved. *)
From Coq Require Import Reals String List Lra Psatz.
From Roadproof Require Import Meaning Prescribed Braking Gained Boundary Joined Aided Assisted.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Section Aeb.
  Variables (W : world) (now : R) (a b : vehicle) (k : aeb).
  Notation par := (parameter W).
  Notation T := (parameter W "cc_ramp").
  Notation A := (parameter W "cc_braking").
  Notation B := (parameter W "aeb_braking").
  Notation v := (speed W now a).
  Notation u := (speed W now b).
  Notation g := (gap W now a b).
  Notation r := (lengths W a b).
  Hypotheses (Ha : 0 <= v) (Hb : 0 <= u) (PT : 0 < T) (PA : 0 < A) (AB : A <= B) (H_delay : 0 <= par "cc_delay").

  Lemma assisted_positive o z t : 0 <= assisted W k o z t.
  Proof.
    assert (R : forall C s, A <= C -> 0 <= ramp T C s) by (intros C s H; apply ramp_positive; lra).
    assert (O : 0 <= match o with Some q => ramp T A (t - q) | None => 0 end) by (destruct o; [apply R|]; lra).
    unfold assisted, Prescribed.par. pose proof (R B (t - z) AB). destruct k.
    - destruct (Rlt_dec t z); [exact O|apply R, AB].
    - apply Rle_trans with (1 := O), Rmax_l.
    - apply Rmin_glb; lra.
  Qed.
  Lemma slower_hits_nobody o z x y : 0 <= g -> v <= u -> 0 <= y -> goes v (assisted W k o z) (z :: nil) x ->
    ~ collide x (fun t => u * t) g r y.
  Proof.
    intros G V Y [L [Z [C [D [X0 X]]]]] [_ [t [H N]]].
    assert (P : forall s, 0 <= s -> 0 <= L s).
    { intros s S. rewrite <- Z. apply (rise_but z L (assisted W k o z)); [exact S|intros; apply C; lra| |intros; apply assisted_positive].
      intros e E1 E2. apply D; [lra|]. intros [E|[]]. apply E2. symmetry. exact E. }
    assert (x t - u * t <= x 0 - u * 0); [|lra].
    apply (falls (fun t => x t - u * t) (fun t => Rmax 0 (v - L t) - u * 1)); [lra| |].
    - intros s S. apply (gain_slope u x (fun t => Rmax 0 (v - L t)) X). lra.
    - intros s S. pose proof (P s ltac:(lra)). assert (Rmax 0 (v - L s) <= u); [|lra]. apply Rmax_lub; lra.
  Qed.

  Lemma assisted_collides q y z x : u < v -> 0 <= g -> 0 <= q -> 0 <= y <= z -> goes v (assisted W k (Some q) z) (z :: nil) x ->
    (collide x (fun t => u * t) g r y
     <-> hits v u g r q y 1 T A /\ (hasGained v u g q y 1 T A \/ aided k (v - u) g q z T A B)).
  Proof.
    intros V G Q Y [L [Z [C [D0 [X0 X]]]]].
    assert (D : forall t, 0 < t -> t <> z -> derivable_pt_lim L t (assisted W k (Some q) z t)).
    { intros t H N. apply D0; [exact H|]. intros [E|[]]. apply N. symmetry. exact E. }
    destruct (brakes_exists v q T A Ha Q ltac:(lra) PA) as [X1 B1].
    destruct (brakes_right v q T A Q ltac:(lra) PA X1 B1) as [X10 D1].
    assert (P : as_ v L 0 z v T A q).
    { apply from_0 with (W := W) (k := k) (q := q) (z := z); try assumption; try lra. intros t H1 H2. unfold assisted, Prescribed.par.
      pose proof (ramp_positive T A (t - q) PT PA) as O. destruct k.
      - destruct (Rlt_dec t z); [reflexivity|lra].
      - rewrite (ramp_low T B) by lra. apply Rmax_left. lra.
      - rewrite (ramp_low T B) by lra. rewrite Rmin_right; lra. }
    assert (S : forall t, 0 <= t <= z -> x t = X1 t).
    { intros t H. assert (Wt : x t = X1 t + (x 0 - X1 0)); [|lra].
      apply way_as with (v := v) (L := L) (h := z) (w := v) (T' := T) (A' := A) (m := q); try assumption; lra. }
    assert (F : forall t t', 0 <= t <= t' -> L t <= L t') by (apply L_grows with (W := W) (k := k) (q := q) (z := z); assumption).
    pose proof (lengths_positive W a b) as Lp.
    assert (NP : (forall t, 0 <= t <= y -> x t - u * t <= g + r) <-> ~ hasEverGained v u (g + r) q y 1 T A).
    { rewrite <- (ever_until v q T A Ha Q ltac:(lra) PA X1 X10 D1 u Hb (g + r) y ltac:(lra) ltac:(lra)).
      rewrite (never_passed x (fun t => u * t)). apply neither.
      split; intros [t [Lt Gt]]; exists t; (split; [exact Lt|]); [rewrite <- (S t) by lra|rewrite (S t) by lra]; exact Gt. }
    unfold collide, hits. rewrite NP.
    rewrite (over_after u x (fun t => Rmax 0 (v - L t)) X (s_falls v L F) y g) by lra. rewrite (S y) by lra.
    assert (AR : over x u g <-> aided k (v - u) g q z T A B).
    { apply assisted_right with (L := L); try assumption; lra. }
    rewrite AR.
    rewrite !(gained_right v q T A Ha Q ltac:(lra) PA X1 X10 D1 u _ y) by lra.
    rewrite <- still_is_faster, (is_faster_right v q T A ltac:(lra) PA u Hb y) by lra.
    assert (E : Rmax 0 (v - L y) = speed_at v q T A y) by (unfold speed_at; rewrite (P y ltac:(lra)); reflexivity).
    rewrite E.
    assert (N : aided k (v - u) g q z T A B -> gains v u g q 1 T A).
    { intros H. apply AR in H.
      apply (from_right v q T A ltac:(lra) PA u). apply (over_right v q T A Ha Q ltac:(lra) PA X1 X10 D1 u Hb g V).
      destruct H as [t [H1 H2]]. exists t. split; [exact H1|]. enough (x t - X1 t <= x 0 - X1 0) by lra.
      apply (falls (fun t => x t - X1 t) (fun t => Rmax 0 (v - L t) - speed_at v q T A t)); [exact H1| |].
      - intros s Hs. apply derivable_pt_lim_minus; [apply X|apply D1]; lra.
      - intros s Hs. unfold speed_at.
        assert (M : lost T A (s - q) <= L s) by (apply L_at_least with (W := W) (k := k) (z := z); try assumption; lra).
        assert (Rmax 0 (v - L s) <= Rmax 0 (v - lost T A (s - q))); [|lra].
        apply Rmax_lub; [apply Rmax_l|]. apply Rle_trans with (2 := Rmax_r _ _). lra. }
    split.
    - intros [H1 H2]. destruct H2 as [H2|[H2 H3]].
      + split; [split; [exact H1|left; lra]|left; lra].
      + split; [split; [exact H1|right; split; [split; assumption|apply N, H3]]|right; exact H3].
    - intros [[H1 H2] H3]. split; [exact H1|]. destruct H2 as [H2|[[_ H2] _]]; [left; lra|].
      destruct H3 as [H3|H3]; [left; lra|right; split; assumption].
  Qed.

  (* --- the formula ------------------------------------------------------------------------------------------ *)
  Definition aidedHits y q z w : Prop :=
    hasGained v u g q y w T A \/ aidedGains k ((v - u) * w ^ 2) (g * w ^ 3) q z w T A B.
  Definition aidedGated y z p x w : Prop :=
    (w * (g - par "cc_ttc" * (v - u)) <= p * (v - u) /\ aidedHits y (p + x) z w)
    \/ (p * (v - u) < w * (g - par "cc_ttc" * (v - u))
        /\ aidedHits (y * (v - u)) (w * (g - par "cc_ttc" * (v - u)) + x * (v - u)) (z * (v - u)) (w * (v - u))).
  Definition wrap y : R := y + Rmin (measure W Width a) (measure W Width b).
  Definition aidedLate p (h : gate) y w : Prop :=
    match h with
    | no_gate => aidedHits y (seen W p y + weighed W p w + par "cc_delay" * w) (wrap y) w
    | before_perception => aidedGated y (wrap y) (seen W p y) (weighed W p w + par "cc_delay" * w) w
    | before_delay => aidedGated y (wrap y) (seen W p y + weighed W p w) (par "cc_delay" * w) w
    end.
  Definition aided_hits p h y w : Prop := careful_hits W now a b p h y w /\ aidedLate p h y w.

  Lemma wrap_after y : 0 <= y -> y < wrap y.
  Proof.
    intros Y. unfold wrap. pose proof (measure_positive W Width a). pose proof (measure_positive W Width b).
    assert (0 < Rmin (measure W Width a) (measure W Width b)) by (apply Rmin_pos; assumption). lra.
  Qed.
  Lemma both_right y q z w o e : u < v -> 0 <= g -> 0 <= q -> 0 <= y <= z -> 0 < w -> o = q / w -> e = z / w ->
    (hit_by_careful W now a b y q w /\ aidedHits y q z w
     <-> exists x, goes v (assisted W k (Some o) e) (e :: nil) x /\ collide x (fun t => u * t) g r (y / w)).
  Proof.
    intros V G Q Y P -> ->.
    assert (Q' : 0 <= q / w) by (apply over_positive; assumption). assert (Y' : 0 <= y / w) by (apply over_positive; lra).
    assert (Z' : y / w <= z / w) by (apply frac_le; lra).
    assert (S2 : aidedHits y q z w <-> hasGained v u g (q / w) (y / w) 1 T A \/ aided k (v - u) g (q / w) (z / w) T A B).
    { unfold aidedHits. rewrite <- (scale_aided w T k (v - u) g (q / w) (z / w) A B P PT PA ltac:(lra)).
      rewrite <- (scale_gained v u g (q / w) (y / w) w T A P). rewrite !times_over by exact P. reflexivity. }
    unfold hit_by_careful. rewrite hits_over by exact P. rewrite S2. split.
    - intros H. assert (AE : exists x, goes v (assisted W k (Some (q / w)) (z / w)) (z / w :: nil) x)
        by (apply assisted_exists; try assumption; lra).
      destruct AE as [x X]. exists x. split; [exact X|].
      apply (assisted_collides (q / w) (y / w) (z / w) x V G Q' ltac:(lra) X). exact H.
    - intros [x [X H]]. apply (assisted_collides (q / w) (y / w) (z / w) x V G Q' ltac:(lra) X). exact H.
  Qed.

  Lemma gated_aeb y w p x e (begins : option R -> Prop) : 0 < w -> 0 <= y -> 0 <= g -> 0 <= p -> 0 <= x -> x = e * w ->
    (u < v -> forall o, begins o <-> exists d, first (close W now a b) (p / w) d /\ o = later e d) ->
    (gated W now a b y w p x /\ aidedGated y (wrap y) p x w
     <-> exists i, (exists o, begins o /\ goes v (assisted W k o (wrap y / w)) (wrap y / w :: nil) i)
       /\ collide i (fun t => u * t) g r (y / w)).
  Proof.
    intros P Y G Hp Hx Ex Bg. pose proof (wrap_after y Y) as Wy. set (z := wrap y) in *.
    refine (iff_trans _ (gate_right W now a b (fun o => goes v (assisted W k o (z / w)) (z / w :: nil))
      (fun c q => hit_by_careful W now a b (y * c) q (w * c) /\ aidedHits (y * c) q (z * c) (w * c)) begins y w p x e P Hp Hx Ex _ _ Bg)).
    - rewrite !Rmult_1_r. unfold gated, aidedGated. split; [|tauto].
      intros [[V [[C H]|[C H]]] [[C' H']|[C' H']]]; try lra; (split; [exact V|]); [left|right]; tauto.
    - intros V o i _ Gi. exact (slower_hits_nobody o (z / w) i (y / w) G V (over_positive y w Y P) Gi).
    - intros V c q o Hc Hq Eo. replace (y / w) with (y * c / (w * c)) by (field; lra).
      apply both_right; try assumption; [nra|apply Rmult_lt_0_compat; lra|field; lra].
  Qed.

  Theorem aeb_boundary p h : known W p -> (from_both W now a b (aided_hits p h) <-> cut_in W now (careful_with_aeb W now k p h a b) a b).
  Proof.
    intros K. apply from_both_right. intros y w P Y G. unfold aided_hits.
    pose proof (seen_positive W p y K Y) as S. pose proof (evaluation_positive W p K) as E.
    assert (E' : 0 <= evaluation W p * w) by (apply Rmult_le_pos; lra).
    assert (D' : 0 <= par "cc_delay" * w) by (apply Rmult_le_pos; lra).
    pose proof (over_positive (seen W p y) w S P) as S'. pose proof (wrap_after y Y) as Wy.
    destruct h; cbn [careful_hits aidedLate]; unfold careful_with_aeb; fold (wrap y).
    - unfold ungated. rewrite weighed_is. destruct (Rle_lt_dec v u) as [V|V].
      + split; [|intros [x [[o [_ Gx]] C]]; exfalso; apply (slower_hits_nobody o (wrap y / w) x (y / w) G V (over_positive y w Y P) Gx C)].
        intros [H _]. exfalso.
        assert (Qp : 0 <= seen W p y + evaluation W p * w + par "cc_delay" * w) by lra.
        apply (hit_by_careful_right W now a b Ha Hb PT PA y _ w _ G Y Qp P eq_refl) in H. destruct H as [x [Bx C]].
        refine (not_faster W now a b Ha Hb PT PA (Some _) x (y / w) G V (over_positive y w Y P) _ Bx C). apply over_positive; assumption.
      + rewrite (both_right y _ (wrap y) w (seen W p y / w + (evaluation W p + par "cc_delay")) (wrap y / w)) by (try lra; field; lra).
        split.
        * intros [x [Gx C]]. exists x. split; [|exact C]. eexists. split; [apply onset_ungated; auto|exact Gx].
        * intros [x [[o [O Gx]] C]]. exists x. split; [|exact C]. apply onset_ungated in O; auto. subst o. exact Gx.
    - apply (gated_aeb y w (seen W p y) _ (evaluation W p + par "cc_delay") (fun o => onset W now p before_perception a b y w o));
        try assumption; [rewrite weighed_is; lra|rewrite weighed_is; ring|].
      intros _ o. apply onset_before_perception; assumption.
    - rewrite weighed_is. apply (gated_aeb y w _ _ (par "cc_delay") (fun o => onset W now p before_delay a b y w o));
        try assumption; [lra|ring|].
      intros _ o. apply onset_before_delay; assumption.
  Qed.
End Aeb.
