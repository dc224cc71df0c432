(* The longitudinal RSS guarantee.  NOT TRUSTED: proved.

   `envelopes` is about the worst motions that are allowed, and is what property P9 says.  `motions` is about all
   motions: of positions it asks that they have speeds, and of speeds bounds on how fast they change, so that
   accelerations may jump; it goes through the mean value theorem.  Only `envelopes` is used by printed claims. *)
From Coq Require Import Reals Lra Psatz.
Open Scope R_scope.

Section Rss.
  Variables a_max b_max b_min rho : R.
  Hypotheses (Ha : 0 <= a_max) (Hb : 0 < b_max) (Hm : 0 < b_min) (Hr : 0 <= rho) (Hmb : b_min <= b_max).

  Definition braking v b t := v * Rmin t (v / b) - b * (Rmin t (v / b)) ^ 2 / 2.
  Definition front v t := braking v b_max t.
  Definition rear v t :=
    v * Rmin t rho + a_max * (Rmin t rho) ^ 2 / 2 + braking (v + a_max * rho) b_min (Rmax 0 (t - rho)).
  Definition dRSS vr vf :=
    Rmax 0 (vr * rho + a_max * rho ^ 2 / 2 + (vr + a_max * rho) ^ 2 / (2 * b_min) - vf ^ 2 / (2 * b_max)).

  Lemma square_over v b : 0 < b -> v ^ 2 / (2 * b) = v * (v / b) / 2.
  Proof. intros. field. lra. Qed.
  Lemma times_over v b : 0 < b -> b * (v / b) = v.
  Proof. intros. field. lra. Qed.

  (* a slower vehicle that brakes harder needs less: u <= v, b' >= b *)
  Lemma stops u v : 0 <= u <= v -> u * (u / b_max) <= v * (v / b_min).
  Proof.
    intros H. pose proof (times_over u b_max Hb). pose proof (times_over v b_min Hm).
    set (p := u / b_max) in *. set (q := v / b_min) in *.
    assert (0 <= p) by nra. assert (p <= q) by nra. nra.
  Qed.

  Lemma grows v t : 0 <= v -> 0 <= t <= rho -> v * t + a_max * t ^ 2 / 2 <= v * rho + a_max * rho ^ 2 / 2.
  Proof.
    intros V T. assert (v * t <= v * rho) by nra. assert (t ^ 2 <= rho ^ 2) by nra.
    assert (a_max * t ^ 2 <= a_max * rho ^ 2) by (apply Rmult_le_compat_l; assumption). lra.
  Qed.

  Theorem envelopes vr vf gap t : 0 <= vr -> 0 <= vf -> 0 <= t -> gap > dRSS vr vf ->
    gap + front vf t - rear vr t > 0.
  Proof.
    intros Hvr Hvf Ht Hg. unfold dRSS in Hg.
    assert (G0 : gap > 0) by (pose proof (Rmax_l 0 (vr * rho + a_max * rho ^ 2 / 2 +
      (vr + a_max * rho) ^ 2 / (2 * b_min) - vf ^ 2 / (2 * b_max))); lra).
    assert (G1 : gap > vr * rho + a_max * rho ^ 2 / 2 + (vr + a_max * rho) ^ 2 / (2 * b_min) - vf ^ 2 / (2 * b_max))
      by (pose proof (Rmax_r 0 (vr * rho + a_max * rho ^ 2 / 2 +
      (vr + a_max * rho) ^ 2 / (2 * b_min) - vf ^ 2 / (2 * b_max))); lra).
    clear Hg. rewrite (square_over vf b_max Hb), (square_over (vr + a_max * rho) b_min Hm) in G1.
    unfold front, rear, braking.
    set (w := vr + a_max * rho) in *.
    assert (Hw : vr <= w) by (unfold w; nra).
    pose proof (times_over vf b_max Hb) as P. pose proof (times_over w b_min Hm) as Q.
    set (p := vf / b_max) in *. set (q := w / b_min) in *.
    assert (Hp : 0 <= p) by nra. assert (Hq : 0 <= q) by nra.
    assert (Hwr : vr * rho + a_max * rho ^ 2 / 2 <= w * rho) by (unfold w; nra).
    destruct (Rle_lt_dec p t) as [Fp|Fp].
    - (* the front vehicle stands *)
      rewrite (Rmin_right t p) by lra.
      assert (F : vf * p - b_max * p ^ 2 / 2 = vf * p / 2) by nra. rewrite F.
      destruct (Rle_lt_dec t rho) as [T|T].
      + rewrite (Rmin_left t rho), (Rmax_left 0 (t - rho)), (Rmin_left 0 q) by lra.
        pose proof (grows vr t Hvr (conj Ht T)).
        assert (0 <= w * q) by nra. nra.
      + rewrite (Rmin_right t rho), (Rmax_right 0 (t - rho)) by lra.
        destruct (Rle_lt_dec q (t - rho)) as [Z|Z].
        * rewrite (Rmin_right (t - rho) q) by lra. nra.
        * rewrite (Rmin_left (t - rho) q) by lra. set (z := t - rho) in *.
          assert (S : 0 <= b_min * (q - z) ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]).
          assert (E : w * q / 2 - (w * z - b_min * z ^ 2 / 2) = b_min * (q - z) ^ 2 / 2) by (rewrite <- Q; field). lra.
    - (* the front vehicle moves *)
      rewrite (Rmin_left t p) by lra.
      assert (Hv : 0 < vf - b_max * t) by nra.
      destruct (Rle_lt_dec t rho) as [T|T].
      + rewrite (Rmin_left t rho), (Rmax_left 0 (t - rho)), (Rmin_left 0 q) by lra.
        destruct (Rle_lt_dec (vr + a_max * t) (vf - b_max * t)) as [V|V].
        { assert ((vr + a_max * t) * t <= (vf - b_max * t) * t) by (apply Rmult_le_compat_r; lra).
          assert (0 <= b_max * t ^ 2) by nra. assert (0 <= a_max * t ^ 2) by nra. nra. }
        assert (V' : 0 <= vf - b_max * t <= w) by (unfold w; nra).
        pose proof (stops _ _ V') as S.
        replace ((vf - b_max * t) / b_max) with (p - t) in S by (unfold p; field; lra).
        fold q in S.
        pose proof (grows vr t Hvr (conj Ht T)).
        assert (E : vf * t - b_max * t ^ 2 / 2 = vf * p / 2 - (vf - b_max * t) * (p - t) / 2) by (rewrite <- P; field).
        assert (E2 : 0 <= w * q) by nra. lra.
      + rewrite (Rmin_right t rho), (Rmax_right 0 (t - rho)) by lra.
        destruct (Rle_lt_dec q (t - rho)) as [Z|Z].
        * rewrite (Rmin_right (t - rho) q) by lra.
          assert (A1 : b_max * t * t <= vf * t) by (apply Rmult_le_compat_r; lra).
          assert (A2 : b_min * t ^ 2 <= b_max * t ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0|lra]).
          assert (B : (rho + q) ^ 2 <= t ^ 2) by (apply pow_incr; lra).
          assert (C : b_min * (rho + q) ^ 2 <= b_min * t ^ 2) by (apply Rmult_le_compat_l; lra).
          assert (D : b_min * (rho + q) ^ 2 = b_min * rho ^ 2 + 2 * w * rho + w * q) by (rewrite <- Q; field).
          assert (E : w * q - b_min * q ^ 2 / 2 = w * q / 2) by (rewrite <- Q; field).
          assert (E3 : 0 <= b_min * rho ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]).
          lra.
        * rewrite (Rmin_left (t - rho) q) by lra.
          assert (Hz : exists z, z = t - rho) by (eexists; reflexivity). destruct Hz as [z Ez].
          rewrite <- Ez in *. assert (Et : t = rho + z) by lra.
          destruct (Rle_lt_dec (w - b_min * z) (vf - b_max * t)) as [V|V].
          -- assert (E1 : (w - b_min * z) * t <= (vf - b_max * t) * t) by (apply Rmult_le_compat_r; lra).
             assert (E2 : b_min * t ^ 2 <= b_max * t ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0|lra]).
             assert (E3 : 0 <= b_min * rho ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]).
             assert (E4 : (w - b_min * z) * t + b_min * t ^ 2 / 2 = w * rho + w * z - b_min * z ^ 2 / 2 + b_min * rho ^ 2 / 2)
               by (rewrite Et; field).
             lra.
          -- assert (V' : 0 <= vf - b_max * t <= w - b_min * z) by lra.
             pose proof (stops _ _ V') as S.
             replace ((vf - b_max * t) / b_max) with (p - t) in S by (unfold p; field; lra).
             replace ((w - b_min * z) / b_min) with (q - z) in S by (unfold q; field; lra).
             assert (E : vf * t - b_max * t ^ 2 / 2 = vf * p / 2 - (vf - b_max * t) * (p - t) / 2) by (rewrite <- P; field).
             assert (E2 : w * z - b_min * z ^ 2 / 2 = w * q / 2 - (w - b_min * z) * (q - z) / 2) by (rewrite <- Q; field).
             lra.
  Qed.

  (* --- motions ---------------------------------------------------------------------------------------- *)
  (* Positions are differentiable and speeds are their derivatives; of speeds nothing but bounds on how fast
     they change is asked, so that accelerations may jump. *)
  Definition moves (x v : R -> R) := forall t, 0 <= t -> derivable_pt_lim x t (v t).

  (* If x' <= y' on [a, b], x gains no more than y. *)
  Lemma gains x v y w a b : a <= b ->
    (forall t, a <= t <= b -> derivable_pt_lim x t (v t)) -> (forall t, a <= t <= b -> derivable_pt_lim y t (w t)) ->
    (forall t, a <= t <= b -> v t <= w t) -> x b - x a <= y b - y a.
  Proof.
    intros L DX DY H. destruct (Req_dec a b) as [<-|N]; [lra|].
    destruct (MVT_cor2 (fun t => y t - x t) (fun t => w t - v t) a b) as [c [E I]]; [lra| |].
    - intros c Hc. apply derivable_pt_lim_minus; auto.
    - specialize (H c). cbv beta in E. assert (v c <= w c) by (apply H; lra). nra.
  Qed.
  Lemma parabola v b : forall t, derivable_pt_lim (fun t => v * t + b * t ^ 2 / 2) t (v + b * t).
  Proof.
    intros t.
    replace (v + b * t) with (v * 1 + b * / 2 * (INR 2 * t ^ (pred 2))) by (simpl; field).
    apply (derivable_pt_lim_plus (fun t => v * t) (fun t => b * t ^ 2 / 2)).
    - apply (derivable_pt_lim_scal id v t 1), derivable_pt_lim_id.
    - apply (derivable_pt_lim_ext (mult_real_fct (b * / 2) (fun t => t ^ 2))).
      + intros s. unfold mult_real_fct. field.
      + apply derivable_pt_lim_scal, derivable_pt_lim_pow.
  Qed.
  Lemma shifted v b c : forall t, derivable_pt_lim (fun t => v * (t - c) + b * (t - c) ^ 2 / 2) t (v + b * (t - c)).
  Proof.
    intros t. replace (v + b * (t - c)) with ((v + b * (t - c)) * 1) by lra.
    apply (derivable_pt_lim_comp (fun t => t - c) (fun t => v * t + b * t ^ 2 / 2)).
    - replace 1 with (1 - 0) by lra. apply derivable_pt_lim_minus; [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
    - apply parabola.
  Qed.
  Lemma still c : forall t, derivable_pt_lim (fun _ => c) t 0.
  Proof. intros. apply derivable_pt_lim_const. Qed.

  Lemma front_gains x v t : moves x v -> 0 <= t ->
    (forall s u, 0 <= s <= u -> v u >= v s - b_max * (u - s)) -> (forall s, 0 <= s -> 0 <= v s) ->
    front (v 0) t <= x t - x 0.
  Proof.
    intros D Ht B V. unfold front, braking.
    set (p := v 0 / b_max). pose proof (times_over (v 0) b_max Hb) as P. fold p in P.
    assert (H0 : 0 <= v 0) by (apply V; lra). assert (0 <= p) by nra.
    set (m := Rmin t p). assert (M : 0 <= m <= t) by (unfold m; split; [apply Rmin_glb; lra|apply Rmin_l]).
    pose proof (gains (fun t => v 0 * t + - b_max * t ^ 2 / 2) (fun t => v 0 + - b_max * t) x v 0 m) as G1.
    pose proof (gains (fun _ => 0) (fun _ => 0) x v m t) as G2.
    cbv beta in *.
    assert (A : v 0 * m + - b_max * m ^ 2 / 2 - (v 0 * 0 + - b_max * 0 ^ 2 / 2) <= x m - x 0).
    { apply G1; [lra|intros; apply parabola|intros; apply D; lra|].
      intros s S. specialize (B 0 s). assert (v s >= v 0 - b_max * (s - 0)) by (apply B; lra). lra. }
    assert (C : 0 - 0 <= x t - x m).
    { apply G2; [lra|intros; apply still|intros; apply D; lra|]. intros s S. apply V. lra. }
    lra.
  Qed.

  Lemma rear_gains x v t : moves x v -> 0 <= t -> 0 <= v 0 ->
    (forall s u, 0 <= s <= u -> u <= rho -> v u <= v s + a_max * (u - s)) ->
    (forall s u, rho <= s <= u -> v u <= Rmax 0 (v s - b_min * (u - s))) ->
    x t - x 0 <= rear (v 0) t.
  Proof.
    intros D Ht H0 A B. unfold rear, braking.
    set (w := v 0 + a_max * rho). pose proof (times_over w b_min Hm) as Q. set (q := w / b_min) in *.
    assert (Hw : 0 <= w) by (unfold w; nra). assert (Hq : 0 <= q) by nra.
    destruct (Rle_lt_dec t rho) as [T|T].
    - rewrite (Rmin_left t rho), (Rmax_left 0 (t - rho)), (Rmin_left 0 q) by lra.
      pose proof (gains x v (fun t => v 0 * t + a_max * t ^ 2 / 2) (fun t => v 0 + a_max * t) 0 t) as G.
      cbv beta in G.
      assert (x t - x 0 <= v 0 * t + a_max * t ^ 2 / 2 - (v 0 * 0 + a_max * 0 ^ 2 / 2)).
      { apply G; [lra|intros; apply D; lra|intros; apply parabola|].
        intros s S. assert (v s <= v 0 + a_max * (s - 0)) by (apply A; lra). lra. }
      lra.
    - rewrite (Rmin_right t rho), (Rmax_right 0 (t - rho)) by lra.
      assert (X1 : x rho - x 0 <= v 0 * rho + a_max * rho ^ 2 / 2).
      { pose proof (gains x v (fun t => v 0 * t + a_max * t ^ 2 / 2) (fun t => v 0 + a_max * t) 0 rho) as G.
        cbv beta in G.
        assert (x rho - x 0 <= v 0 * rho + a_max * rho ^ 2 / 2 - (v 0 * 0 + a_max * 0 ^ 2 / 2)); [|lra].
        apply G; [lra|intros; apply D; lra|intros; apply parabola|].
        intros s S. assert (v s <= v 0 + a_max * (s - 0)) by (apply A; lra). lra. }
      assert (W : v rho <= w). { assert (v rho <= v 0 + a_max * (rho - 0)) by (apply A; lra). unfold w. lra. }
      set (m := Rmin (t - rho) q).
      assert (M : 0 <= m <= t - rho) by (unfold m; split; [apply Rmin_glb; lra|apply Rmin_l]).
      assert (Mq : m <= q) by (unfold m; apply Rmin_r).
      assert (X2 : x (rho + m) - x rho <= w * m - b_min * m ^ 2 / 2).
      { pose proof (gains x v (fun t => w * (t - rho) + - b_min * (t - rho) ^ 2 / 2)
          (fun t => w + - b_min * (t - rho)) rho (rho + m)) as G. cbv beta in G.
        assert (x (rho + m) - x rho <= w * (rho + m - rho) + - b_min * (rho + m - rho) ^ 2 / 2
          - (w * (rho - rho) + - b_min * (rho - rho) ^ 2 / 2)).
        { apply G; [lra|intros; apply D; lra|intros; apply shifted|].
          intros s S. assert (C : v s <= Rmax 0 (v rho - b_min * (s - rho))) by (apply B; lra).
          assert (0 <= w - b_min * (s - rho)) by nra.
          assert (Rmax 0 (v rho - b_min * (s - rho)) <= w - b_min * (s - rho)) by (apply Rmax_lub; lra). lra. }
        replace (rho + m - rho) with m in H by lra. replace (rho - rho) with 0 in H by lra. lra. }
      assert (X3 : x t - x (rho + m) <= 0).
      { unfold m, Rmin in *. destruct (Rle_dec (t - rho) q) as [L|L].
        - replace (rho + (t - rho)) with t by lra. lra.
        - pose proof (gains x v (fun _ => 0) (fun _ => 0) (rho + q) t) as G. cbv beta in G.
          assert (x t - x (rho + q) <= 0 - 0); [|lra].
          apply G; [lra|intros; apply D; lra|intros; apply still|].
          intros s S. assert (C : v s <= Rmax 0 (v rho - b_min * (s - rho))) by (apply B; lra).
          assert (b_min * (s - rho) >= w) by nra.
          rewrite Rmax_left in C by lra. exact C. }
      lra.
  Qed.

  (* The guarantee for motions: xr and xf are the front end of the rear vehicle and the rear end of the front one. *)
  Theorem motions xr vr xf vf :
    moves xr vr -> moves xf vf ->
    (forall s, 0 <= s -> 0 <= vf s) -> 0 <= vr 0 ->
    (forall s u, 0 <= s <= u -> vf u >= vf s - b_max * (u - s)) ->
    (forall s u, 0 <= s <= u -> u <= rho -> vr u <= vr s + a_max * (u - s)) ->
    (forall s u, rho <= s <= u -> vr u <= Rmax 0 (vr s - b_min * (u - s))) ->
    xf 0 - xr 0 > dRSS (vr 0) (vf 0) ->
    forall t, 0 <= t -> xr t < xf t.
  Proof.
    intros Dr Df Vf Vr Bf Ar Br Gap t Ht.
    pose proof (front_gains xf vf t Df Ht Bf Vf) as F.
    pose proof (rear_gains xr vr t Dr Ht Vr Ar Br) as R.
    assert (Vf0 : 0 <= vf 0) by (apply Vf; lra).
    pose proof (envelopes (vr 0) (vf 0) (xf 0 - xr 0) t Vr Vf0 Ht Gap). lra.
  Qed.
End Rss.
