(* The boundaries of RSS: a vehicle that accelerates for rho, and then brakes.  NOT TRUSTED: proved.

   From the end of its response on it moves as one that has had its greater speed all along, from a place farther
   back: so the theorems about vehicles that brake say what it gains from then on. *)
From Coq Require Import Reals String List Lra Psatz.
From Roadproof Require Import Meaning Prescribed Braking Gained Boundary Braked Following.
Import ListNotations.
Open Scope string_scope.
Open Scope R_scope.

Section Response.
  Variables (W : world) (now : R) (a : vehicle) (s : R).
  Notation v := (speed W now a).
  Notation A := (parameter W "a_max").
  Notation B := (parameter W "b_min").
  Notation rho := (parameter W "rho").
  Hypotheses (Hv : 0 <= v) (Hs : 0 <= s) (HA : 0 <= A) (HB : 0 < B) (Hr : 0 <= rho).
  Notation faster := (v + A * rho).
  Notation ends := (s + rho).

  Definition response_speed t := if Rle_dec t s then v else if Rle_dec t ends then v + A * (t - s) else speed_at faster ends 0 B t.

  Lemma faster_positive : 0 <= A * rho. Proof. apply Rmult_le_pos; assumption. Qed.

  Section Given.
    Variable x : R -> R.
    Hypothesis G : responds W now a s x.
    Lemma responds_right : x 0 = 0 /\ forall t, 0 <= t -> derivable_pt_lim x t (response_speed t).
    Proof.
      destruct G as [taken [Z [C [D [X0 X]]]]]. split; [exact X0|]. intros t T.
      replace (response_speed t) with (Rmax 0 (v - taken t)); [apply X; exact T|].
      pose proof faster_positive as F.
      assert (N : forall u, u <> s -> u <> ends -> ~ In u [s; ends]) by (intros u N1 N2 [E|[E|[]]]; [apply N1|apply N2]; symmetry; exact E).
      assert (B1 : forall u, 0 <= u <= s -> taken u = 0).
      { intros u U. rewrite (gains_cubic taken (fun t => response W (t - s)) 0 u 0 0 0 0); [lra|lra| | |].
        - intros z Hz. apply C. lra.
        - intros z Hz. apply D; [lra|apply N; lra].
        - intros z Hz. unfold response. destruct (Rlt_dec (z - s) 0); lra. }
      assert (B2 : forall u, s <= u <= ends -> taken u = - A * (u - s)).
      { intros u U. rewrite (gains_cubic taken (fun t => response W (t - s)) s u s (- A) 0 0).
        - rewrite B1 by lra. ring.
        - lra.
        - intros z Hz. apply C. lra.
        - intros z Hz. apply D; [lra|apply N; lra].
        - intros z Hz. unfold response, Prescribed.par. destruct (Rlt_dec (z - s) 0); [lra|]. destruct (Rlt_dec (z - s) rho); lra. }
      assert (B3 : forall u, ends <= u -> taken u = - A * rho + B * (u - ends)).
      { intros u U. rewrite (gains_cubic taken (fun t => response W (t - s)) ends u ends B 0 0).
        - rewrite B2 by lra. ring.
        - lra.
        - intros z Hz. apply C. lra.
        - intros z Hz. apply D; [lra|apply N; lra].
        - intros z Hz. unfold response, Prescribed.par. destruct (Rlt_dec (z - s) 0); [lra|]. destruct (Rlt_dec (z - s) rho); lra. }
      unfold response_speed. destruct (Rle_dec t s) as [L|L].
      - rewrite B1 by lra. rewrite Rmax_right; lra.
      - destruct (Rle_dec t ends) as [M|M].
        + rewrite B2 by lra. assert (0 <= A * (t - s)) by (apply Rmult_le_pos; lra). rewrite Rmax_right; lra.
        + rewrite B3 by lra. unfold speed_at. rewrite lost_full by lra. f_equal. field.
    Qed.
    Lemma x_continuous_ t : 0 <= t -> continuity_pt x t.
    Proof. intros T. apply derivable_continuous_pt. eexists. apply responds_right. exact T. Qed.
    Lemma before_response t : 0 <= t <= s -> x t = v * t.
    Proof.
      intros T. destruct responds_right as [X0 X]. rewrite (gains_cubic x response_speed 0 t 0 v 0 0); [lra|lra| | |].
      - intros z Hz. apply x_continuous_. lra.
      - intros z Hz. apply X. lra.
      - intros z Hz. unfold response_speed. destruct (Rle_dec z s); lra.
    Qed.
    Lemma in_response t : s <= t <= ends -> x t = v * t + A * (t - s) ^ 2 / 2.
    Proof.
      intros T. destruct responds_right as [X0 X]. rewrite (gains_cubic x response_speed s t s v (A / 2) 0).
      - rewrite before_response by lra. field.
      - lra.
      - intros z Hz. apply x_continuous_. lra.
      - intros z Hz. apply X. lra.
      - intros z Hz. unfold response_speed. destruct (Rle_dec z s); [lra|]. destruct (Rle_dec z ends); [field|lra].
    Qed.
    (* X goes as if it had been so fast all along *)
    Variable X : R -> R.
    Hypothesis GX : brakes_from faster (Some ends) 0 B X.
    Lemma X_right : X 0 = 0 /\ forall t, 0 <= t -> derivable_pt_lim X t (speed_at faster ends 0 B t).
    Proof. apply brakes_right; [lra|lra|exact HB|exact GX]. Qed.
    Lemma X_before t : 0 <= t <= ends -> X t = faster * t.
    Proof. destruct X_right as [X0 D]. pose proof faster_positive. apply (x_before faster ends 0 B); [lra|exact X0|exact D]. Qed.
    Lemma after_response t : ends <= t -> x t = X t - A * rho * ends + A * rho ^ 2 / 2.
    Proof.
      intros T. destruct X_right as [X0 D]. destruct responds_right as [_ Dx].
      assert (E : x t - x ends = X t - X ends).
      { apply (same_gain x X (speed_at faster ends 0 B)); [exact T| | | |].
        - intros z Hz. apply x_continuous_. lra.
        - intros z Hz. apply derivable_continuous_pt. eexists. apply D. lra.
        - intros z Hz. replace (speed_at faster ends 0 B z) with (response_speed z); [apply Dx; lra|].
          unfold response_speed. destruct (Rle_dec z s); [lra|]. destruct (Rle_dec z ends); [lra|reflexivity].
        - intros z Hz. apply D. lra. }
      rewrite (in_response ends) in E by lra. rewrite (X_before ends) in E by lra. replace (ends - s) with rho in E by ring. lra.
    Qed.
    Lemma never_before t : s <= t <= ends -> X t - A * rho * ends + A * rho ^ 2 / 2 <= x t.
    Proof.
      intros T. rewrite in_response, X_before by lra.
      assert (0 <= A * (ends - t) ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]). nra.
    Qed.
    Lemma response_rises t u : 0 <= t <= u -> u <= ends -> response_speed t <= response_speed u.
    Proof.
      intros T U. unfold response_speed.
      destruct (Rle_dec t s), (Rle_dec u s), (Rle_dec t ends), (Rle_dec u ends); try lra; nra.
    Qed.
  End Given.

  Lemma responds_exists : exists x, responds W now a s x.
  Proof.
    pose proof faster_positive as F. assert (V : 0 <= faster / B) by (apply over_positive; lra).
    apply (goes_exists _ _ _ (fun t => lost 0 B (t - ends) + (lost 0 A (t - ends) - lost 0 A (t - s))) (ends + faster / B)).
    - rewrite !lost_before by lra. ring.
    - intros t _. assert (K : forall k c, continuity_pt (fun t => lost 0 k (t - c)) t).
      { intros k c. apply (continuous_ext (fun t => k * Rmax 0 (t - c))); [intros; symmetry; apply lost_at_once|].
        apply (continuity_pt_scal (fun t => Rmax 0 (t - c)) k), max_continuous, derivable_continuous_pt.
        eexists. apply (derivable_pt_lim_minus id (fun _ => c)); [apply derivable_pt_lim_id|apply derivable_pt_lim_const]. }
      apply (continuity_pt_plus (fun t => lost 0 B (t - ends)) (fun t => lost 0 A (t - ends) - lost 0 A (t - s))); [apply K|].
      apply (continuity_pt_minus (fun t => lost 0 A (t - ends)) (fun t => lost 0 A (t - s))); apply K.
    - intros t T N. assert (N1 : t <> s) by (intros ->; apply N; left; reflexivity).
      assert (N2 : t <> ends) by (intros ->; apply N; right; left; reflexivity).
      assert (K : forall k c, t <> c -> derivable_pt_lim (fun t => lost 0 k (t - c)) t (ramp 0 k (t - c))).
      { intros k c Nc. apply shift, lost_slope_at_once. lra. }
      replace (response W (t - s)) with (ramp 0 B (t - ends) + (ramp 0 A (t - ends) - ramp 0 A (t - s))).
      + apply (derivable_pt_lim_plus (fun t => lost 0 B (t - ends)) (fun t => lost 0 A (t - ends) - lost 0 A (t - s)));
          [apply K; exact N2|].
        apply (derivable_pt_lim_minus (fun t => lost 0 A (t - ends)) (fun t => lost 0 A (t - s))); apply K; assumption.
      + unfold response, ramp, Prescribed.par.
        destruct (Rlt_dec (t - ends) 0), (Rlt_dec (t - s) 0), (Rlt_dec (t - s) rho); lra.
    - lra.
    - intros t T. assert (Be : B * (faster / B) = faster) by (field; lra). set (z := faster / B) in *.
      rewrite !lost_full by lra. rewrite !Rmax_left; [reflexivity|nra|nra].
  Qed.
End Response.

Section Boundaries.
  Variables (W : world) (now : R) (a b : vehicle).
  Notation v := (speed W now a).
  Notation u := (speed W now b).
  Notation g := (gap W now a b).
  Notation A := (parameter W "a_max").
  Notation B := (parameter W "b_min").
  Notation rho := (parameter W "rho").
  Hypotheses (Hv : 0 <= v) (Hu : 0 <= u) (HA : 0 <= A) (HB : 0 < B) (Hr : 0 <= rho).
  Notation faster := (v + A * rho).

  (* --- a vehicle of constant speed --- *)
  Section Against.
    Variables (s : R) (x : R -> R).
    Hypotheses (Hs : 0 <= s) (Hg : 0 <= g) (Gx : responds W now a s x).
    Notation ends := (s + rho).
    Let E t := x t - u * t.
    Lemma E_slope t : 0 <= t -> derivable_pt_lim E t (response_speed W now a s t - u * 1).
    Proof.
      intros T. apply derivable_pt_lim_minus; [apply (responds_right W now a s Hv Hs HA HB Hr x Gx); exact T|].
      apply (derivable_pt_lim_scal id u t 1), derivable_pt_lim_id.
    Qed.
    Definition responds_late : Prop := u < faster /\ 2 * B * (g - A * rho ^ 2 / 2 - (v - u) * ends) < (faster - u) ^ 2.
    Lemma ever_responding : (exists t, s <= t /\ E t > g) <-> (v - u) * s > g \/ responds_late.
    Proof.
      pose proof (faster_positive W HA Hr) as F.
      destruct (brakes_exists faster ends 0 B ltac:(lra) ltac:(lra) (Rle_refl 0) HB) as [X BX].
      destruct (brakes_right faster ends 0 B ltac:(lra) (Rle_refl 0) HB X BX) as [X0 DX].
      set (G' := g + A * rho * ends - A * rho ^ 2 / 2).
      assert (G0 : 0 <= G').
      { unfold G'. assert (0 <= A * (rho * s)) by (apply Rmult_le_pos; [lra|apply Rmult_le_pos; lra]).
        assert (0 <= A * rho ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]). nra. }
      assert (same : forall t, ends <= t -> (E t > g <-> X t - u * t > G')).
      { intros t T. unfold E. rewrite (after_response W now a s Hv Hs HA HB Hr x Gx X BX t T). unfold G'. split; lra. }
      assert (Es : E s = (v - u) * s).
      { unfold E. rewrite (before_response W now a s Hv Hs HA HB Hr x Gx s) by lra. ring. }
      set (m := meets faster ends 0 B u).
      assert (gains_is : u < faster -> (g < E m <-> responds_late) /\ ends <= m).
      { intros L. pose proof (meets_after faster ends 0 B ltac:(lra) HB u ltac:(lra)) as M. fold m in M. split; [|exact M].
        transitivity (gains faster u G' ends 1 0 B).
        - rewrite (gains_right faster ends 0 B ltac:(lra) ltac:(lra) (Rle_refl 0) HB X X0 DX u Hu). fold m.
          pose proof (same m M) as S. unfold Rgt in S. rewrite S. tauto.
        - unfold gains, responds_late. split.
          + intros [L' [[_ H]|[N _]]]; [|lra]. split; [exact L|]. unfold G' in H. lra.
          + intros [_ H]. split; [exact L|]. left. split; [lra|]. unfold G'. lra. }
      assert (rises : forall t, ends <= t -> u < faster -> E t > g -> responds_late).
      { intros t T L H. apply (gains_is L). 
        assert (K : gains faster u G' ends 1 0 B \/ hasGained faster u G' ends ends 1 0 B).
        { assert (Q : exists t, ends <= t /\ X t - u * t > G') by (exists t; split; [exact T|apply same; assumption]).
          apply (ever faster ends 0 B ltac:(lra) ltac:(lra) (Rle_refl 0) HB X X0 DX u Hu G' ends ltac:(lra)) in Q. tauto. }
        destruct (gains_is L) as [_ M]. apply Rgt_lt, same; [exact M|].
        destruct K as [K|K].
        - apply (gains_right faster ends 0 B ltac:(lra) ltac:(lra) (Rle_refl 0) HB X X0 DX u Hu) in K. fold m in K. lra.
        - apply (gained_right faster ends 0 B ltac:(lra) ltac:(lra) (Rle_refl 0) HB X X0 DX u G' ends ltac:(lra)) in K.
          assert (X ends - u * ends <= X m - u * m); [|lra].
          apply (grows (fun t => X t - u * t) (fun t => speed_at faster ends 0 B t - u * 1)); [exact M| |].
          + intros z Hz. apply (gained_slope faster ends 0 B X DX). lra.
          + intros z Hz. pose proof (faster_until faster ends 0 B (Rle_refl 0) HB u z (Rlt_le _ _ L) (proj2 Hz)). lra. }
      split.
      - intros [t [T H]]. destruct (Rlt_le_dec g (E s)) as [Q|Q]; [left; lra|right].
        destruct (Rle_lt_dec ends t) as [L|L].
        + destruct (Rlt_le_dec u faster) as [V|V]; [apply (rises t L V H)|]. exfalso.
          assert (E t <= E s); [|lra]. apply (falls E (fun t => response_speed W now a s t - u * 1)); [exact T|intros; apply E_slope; lra|].
          intros z Hz. unfold response_speed. destruct (Rle_dec z s); [lra|]. destruct (Rle_dec z ends).
          * assert (A * (z - s) <= A * rho) by (apply Rmult_le_compat_l; lra). lra.
          * pose proof (never_faster faster ends 0 B HB u Hu z V). lra.
        + assert (Sl : response_speed W now a s t - u > 0).
          { apply Rnot_le_gt. intros N. assert (E t <= E s); [|lra].
            apply (falls E (fun t => response_speed W now a s t - u * 1)); [exact T|intros; apply E_slope; lra|].
            intros z Hz. pose proof (response_rises W now a s HA z t ltac:(lra) ltac:(lra)). lra. }
          assert (V : u < faster).
          { unfold response_speed in Sl. destruct (Rle_dec t s); [lra|]. destruct (Rle_dec t ends); [|lra].
            assert (A * (t - s) <= A * rho) by (apply Rmult_le_compat_l; lra). lra. }
          apply (rises ends ltac:(lra) V). assert (E t <= E ends); [|lra].
          apply (grows E (fun t => response_speed W now a s t - u * 1)); [lra|intros; apply E_slope; lra|].
          intros z Hz. pose proof (response_rises W now a s HA t z ltac:(lra) ltac:(lra)). lra.
      - intros [H|H]; [exists s; split; lra|]. destruct H as [V H]. destruct (gains_is V) as [M1 M2].
        exists m. split; [lra|]. apply M1. split; assumption.
    Qed.
  End Against.

  Definition rss_hits y w : Prop :=
    (v - u) * y <= w * (g + lengths W a b)
    /\ (w * g < (v - u) * y
        \/ (u < faster /\ 2 * B * (w * (g - A * rho ^ 2 / 2) - (v - u) * (y + rho * w)) < w * (faster - u) ^ 2)).
  Theorem rss_boundary : from_both W now a b rss_hits <-> cut_in W now (rss W now a) a b.
  Proof.
    apply from_both_right. intros y w P Y G. unfold rss_hits.
    pose proof (over_positive y w Y P) as S. assert (Ey : y = w * (y / w)) by (field; lra). set (s := y / w) in *.
    assert (R : forall x, rss W now a y w x <-> responds W now a s x).
    { intros x. unfold rss. split.
      - intros [z [F D]]. apply (reaches y w (Some z) Y P) in F. injection F as ->. exact D.
      - intros D. exists s. split; [apply (reaches y w (Some s) Y P); reflexivity|exact D]. }
    assert (C : forall x, responds W now a s x -> (collide x (fun t => u * t) g (lengths W a b) s
      <-> (v - u) * s <= g + lengths W a b /\ ((v - u) * s > g \/ responds_late s))).
    { intros x D. unfold collide. rewrite (ever_responding s x S G D). apply and_iff_compat_r.
      pose proof (lengths_positive W a b) as L. split.
      - intros N. specialize (N s ltac:(lra)). rewrite (before_response W now a s Hv S HA HB Hr x D s) in N by lra. lra.
      - intros N t H. rewrite (before_response W now a s Hv S HA HB Hr x D t) by lra.
        destruct (Rle_lt_dec (v - u) 0); [nra|]. assert ((v - u) * t <= (v - u) * s) by (apply Rmult_le_compat_l; lra). lra. }
    assert (K : responds_late s <-> (u < faster
      /\ 2 * B * (w * (g - A * rho ^ 2 / 2) - (v - u) * (y + rho * w)) < w * (faster - u) ^ 2)).
    { unfold responds_late. apply both; [reflexivity|]. symmetry. apply (scaled_lt w); [exact P|rewrite Ey; ring|ring]. }
    rewrite <- K.
    assert (K1 : (v - u) * y <= w * (g + lengths W a b) <-> (v - u) * s <= g + lengths W a b)
      by (apply (scaled_le w); [exact P|rewrite Ey; ring|ring]).
    assert (K2 : w * g < (v - u) * y <-> g < (v - u) * s) by (apply (scaled_lt w); [exact P|ring|rewrite Ey; ring]).
    rewrite K1, K2. split.
    - intros H. destruct (responds_exists W now a s Hv S HA HB Hr) as [x D]. exists x. split; [apply R; exact D|apply C; [exact D|exact H]].
    - intros [x [D H]]. apply R in D. apply (C x D) in H. exact H.
  Qed.

  (* --- a vehicle that brakes --- *)
  Definition rss_following_hits : Prop :=
    ahead W now a b (gainsBraking faster u (-1 * value W Acceleration_lon b now) (g + A * rho ^ 2 / 2) rho 0 B).
  Theorem rss_following_boundary : rss_following_hits <-> decelerates W now (rss_following W now a) a b.
  Proof.
    unfold rss_following_hits, rss_following. apply ahead_right.
    2:{ intros x D. apply (responds_right W now a 0 Hv (Rle_refl 0) HA HB Hr x D). }
    intros P G. replace (-1 * value W Acceleration_lon b now) with (braking W now b) by (unfold braking; ring).
    pose proof (faster_positive W HA Hr) as F. set (k := braking W now b) in *.
    assert (G0 : 0 <= g + A * rho ^ 2 / 2) by (assert (0 <= A * rho ^ 2) by (apply Rmult_le_pos; [lra|apply pow2_ge_0]); lra).
    assert (Z : 0 + rho = rho) by ring.
    destruct (brakes_exists faster rho 0 B ltac:(lra) Hr (Rle_refl 0) HB) as [X BX].
    destruct (brakes_right faster rho 0 B Hr (Rle_refl 0) HB X BX) as [X0 DX].
    assert (C : forall x, responds W now a 0 x -> forall p, brakes_from u (Some 0) 0 k p ->
      ((exists t, 0 <= t /\ x t - p t > g) <-> gainsBraking faster u k (g + A * rho ^ 2 / 2) rho 0 B)).
    { intros x D p Bp. destruct (brakes_right u 0 0 k (Rle_refl 0) (Rle_refl 0) P p Bp) as [P0 Dp].
      assert (BX' : brakes_from faster (Some (0 + rho)) 0 B X) by (rewrite Z; exact BX).
      destruct (responds_right W now a 0 Hv (Rle_refl 0) HA HB Hr x D) as [x0 Dx].
      rewrite <- (ever_braking faster u k _ rho 0 B ltac:(lra) Hu P G0 Hr (Rle_refl 0) HB X p X0 P0 DX Dp).
      unfold Braked.D.
      assert (after : forall t, rho <= t -> x t = X t - A * rho ^ 2 / 2).
      { intros t T. rewrite (after_response W now a 0 Hv (Rle_refl 0) HA HB Hr x D X BX' t) by lra. rewrite Z. field. }
      split.
      - intros [t [T H]]. destruct (Rle_lt_dec rho t) as [L|L]; [exists t; split; [exact T|rewrite (after t L) in H; lra]|].
        exists rho. split; [exact Hr|]. enough (Q : x t - p t <= x rho - p rho) by (rewrite (after rho (Rle_refl rho)) in Q; lra).
        set (E := fun t => x t - p t).
        assert (slope : forall z, 0 <= z -> derivable_pt_lim E z (response_speed W now a 0 z - speed_at u 0 0 k z)).
        { intros z Hz. apply derivable_pt_lim_minus; [apply Dx|apply Dp]; exact Hz. }
        assert (up : forall z y, 0 <= z <= y -> y <= rho ->
          response_speed W now a 0 z - speed_at u 0 0 k z <= response_speed W now a 0 y - speed_at u 0 0 k y).
        { intros z y Hz Hy. pose proof (response_rises W now a 0 HA z y ltac:(lra) ltac:(lra)).
          assert (speed_at u 0 0 k y <= speed_at u 0 0 k z); [|lra].
          unfold speed_at. rewrite !lost_full by lra. apply Rmax_lub; [apply Rmax_l|].
          apply Rle_trans with (2 := Rmax_r _ _). assert (k * z <= k * y) by (apply Rmult_le_compat_l; lra). lra. }
        destruct (Rlt_le_dec (response_speed W now a 0 t - speed_at u 0 0 k t) 0) as [N|N].
        + exfalso. assert (E t <= E 0); [|unfold E in *; rewrite x0, P0 in *; lra].
          apply (falls E (fun z => response_speed W now a 0 z - speed_at u 0 0 k z)); [exact T|intros; apply slope; lra|].
          intros z Hz. pose proof (up z t ltac:(lra) ltac:(lra)). lra.
        + apply (grows E (fun z => response_speed W now a 0 z - speed_at u 0 0 k z)); [lra|intros; apply slope; lra|].
          intros z Hz. pose proof (up t z ltac:(lra) ltac:(lra)). lra.
      - intros [t [T H]]. exists t. split; [exact T|]. destruct (Rle_lt_dec rho t) as [L|L]; [rewrite (after t L); lra|].
        pose proof (never_before W now a 0 Hv (Rle_refl 0) HA HB Hr x D X BX' t ltac:(lra)) as N. rewrite Z in N. lra. }
    split.
    - intros H. destruct (responds_exists W now a 0 Hv (Rle_refl 0) HA HB Hr) as [x D].
      destruct (brakes_exists u 0 0 k Hu (Rle_refl 0) (Rle_refl 0) P) as [p Bp].
      exists x. split; [exact D|]. exists p. split; [exact Bp|]. apply (C x D p Bp). exact H.
    - intros [x [D [p [Bp H]]]]. apply (C x D p Bp). exact H.
  Qed.
End Boundaries.
