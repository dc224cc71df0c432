(* What driver models prescribe.  TRUSTED: read this file and Meaning.v beside docs/explanation/preventable.md.

   How vehicles move from the state of a world at one instant on, which is time 0 here, and when they collide.
   Lengths are in m, times in s.  Nothing here is about proofs, or about the formulas of the library. *)
From Coq Require Import Reals List String.
From Roadproof Require Import Meaning.
Open Scope R_scope.

(* Braking s seconds after it begins: it grows evenly to A in T seconds, and stays; where T = 0 it is A at once. *)
Definition ramp (T A s : R) : R := if Rlt_dec s 0 then 0 else if Rlt_dec s T then A * s / T else A.

(* x is the way of a vehicle that has the speed v at time 0 and brakes so: its speed is v less what braking has
   taken of it, and never below 0.  At the instants `jumps` braking may jump. *)
Definition goes (v : R) (braking : R -> R) (jumps : list R) (x : R -> R) : Prop :=
  exists taken, taken 0 = 0 /\ (forall t, 0 <= t -> continuity_pt taken t)
    /\ (forall t, 0 < t -> ~ In t jumps -> derivable_pt_lim taken t (braking t))
    /\ x 0 = 0 /\ (forall t, 0 <= t -> derivable_pt_lim x t (Rmax 0 (v - taken t))).
(* It brakes to a stand from its onset on; without an onset it never brakes. *)
Definition brakes_from (v : R) (onset : option R) (T A : R) : (R -> R) -> Prop :=
  match onset with Some q => goes v (fun t => ramp T A (t - q)) (q :: nil) | None => goes v (fun _ => 0) nil end.

(* SV goes x.  A vehicle ahead by g goes p, and is in the way of SV from `arrives` on; r is both lengths.  They
   collide where SV has never passed it until then, and at some time later the front of SV is beyond its rear. *)
Definition collide (x p : R -> R) (g r arrives : R) : Prop :=
  (forall t, 0 <= t <= arrives -> x t - p t <= g + r) /\ exists t, arrives <= t /\ x t - p t > g.

(* The first instant from s on at which P is so; None where it never is. *)
Definition first (P : R -> Prop) (s : R) (found : option R) : Prop :=
  match found with
  | Some t => s <= t /\ P t /\ forall u, s <= u < t -> ~ P u
  | None => forall t, s <= t -> ~ P t
  end.
Definition later (delay : R) : option R -> option R := option_map (fun t => t + delay).

(* Readings of the regulation (docs/explanation/preventable.md). *)
Inductive perception := by_time | by_distance | by_overlap.
Inductive gate := no_gate | before_perception | before_delay.
Inductive aeb := in_place | greater | together.

Section State.
  Variables (W : world) (now : R).
  Definition par (p : string) : R := parameter W p.
  Definition speed a := value W Speed_lon a now.
  Definition gap a b := value W Place_lon b now - measure W Length b - value W Place_lon a now.
  Definition lengths a b := measure W Length a + measure W Length b.
  (* from the left side of a to the right side of b *)
  Definition beside a b := value W Place_lat b now - measure W Width b - value W Place_lat a now.

  (* --- manoeuvres: b is ahead of a, which is SV, and a goes as `driver` prescribes ----------------------- *)
  (* b is beside a by y, and comes into its way at w, at a constant speed along the road. *)
  Definition comes_in (driver : R -> R -> (R -> R) -> Prop) a b (y w : R) : Prop :=
    w > 0 /\ y >= 0 /\ gap a b >= 0
    /\ exists x, driver y w x /\ collide x (fun t => speed b * t) (gap a b) (lengths a b) (y / w).
  Definition cut_in driver a b : Prop :=
    comes_in driver a b (beside a b) (- value W Speed_lat b now) \/ comes_in driver a b (beside b a) (value W Speed_lat b now).

  (* --- drivers in a cut-in: of a, b being beside by y and coming in at w ---------------------------------- *)
  (* 5.2.5.2 of UN R157, and EU 2022/1426: full braking some time after b is so far past the marking, which is
     midway between the boxes. *)
  Definition after_intrusion (delay A v y w : R) (x : R -> R) : Prop :=
    exists s, first (fun t => y / 2 + par "r157_past" <= w * t) 0 s /\ brakes_from v (later delay s) 0 A x.
  Definition r157 a : R -> R -> (R -> R) -> Prop := after_intrusion (par "r157_delay") (par "r157_braking") (speed a).
  Definition eu1426 a : R -> R -> (R -> R) -> Prop :=
    after_intrusion (par "eu1426_delay" + par "eu1426_ramp" / 2) (par "eu1426_braking") (speed a).
  (* The competent and careful driver of UN R157, Annex 3.  b is perceived once it has moved so far. *)
  Definition perceived (p : perception) (y w t : R) : Prop :=
    match p with
    | by_time => par "cc_wander"
    | by_distance => par "cc_wander" + par "cc_drift"
    | by_overlap => y
    end <= w * t.
  Definition evaluation (p : perception) : R := match p with by_time => par "cc_evaluation" | _ => 0 end.
  (* The time to collision, while a goes on at its speed, is at most that of the gate. *)
  Definition close a b (t : R) : Prop :=
    gap a b - (speed a - speed b) * t <= par "cc_ttc" * (speed a - speed b).
  Definition onset (p : perception) (g : gate) a b (y w : R) (o : option R) : Prop :=
    match g with
    | no_gate => exists s, first (perceived p y w) 0 s /\ o = later (evaluation p + par "cc_delay") s
    | before_perception =>
        exists s, first (fun t => perceived p y w t /\ close a b t) 0 s /\ o = later (evaluation p + par "cc_delay") s
    | before_delay =>
        exists s d, first (perceived p y w) 0 (Some s) /\ first (close a b) (s + evaluation p) d /\ o = later (par "cc_delay") d
    end.
  Definition careful p g a b (y w : R) (x : R -> R) : Prop :=
    exists o, onset p g a b y w o /\ brakes_from (speed a) o (par "cc_ramp") (par "cc_braking") x.

  (* AEB, which Table 1 adds after full wrap: when b is within the width of a or covers it, at z, it begins to brake
     by a ramp of its own: in place of the driver, whose ramp it goes on with; or the greater of both counts; or
     their sum, up to that of AEB. *)
  Definition assisted (h : aeb) (o : option R) (z t : R) : R :=
    let own := match o with Some q => ramp (par "cc_ramp") (par "cc_braking") (t - q) | None => 0 end in
    let by_aeb m := ramp (par "cc_ramp") (par "aeb_braking") (t - m) in
    match h with
    | in_place => if Rlt_dec t z then own else by_aeb (match o with Some q => Rmin q z | None => z end)
    | greater => Rmax own (by_aeb z)
    | together => Rmin (par "aeb_braking") (own + by_aeb z)
    end.
  Definition careful_with_aeb (h : aeb) p g a b (y w : R) (x : R -> R) : Prop :=
    let z := (y + Rmin (measure W Width a) (measure W Width b)) / w in
    exists o, onset p g a b y w o /\ goes (speed a) (assisted h o z) (z :: nil) x.

  (* --- a cut-out: b, which a follows, leaves the way of a at w; c, ahead of both and not faster, goes on ---- *)
  Definition in_way a b : Prop := beside a b <= 0 /\ beside b a <= 0.
  Definition cut_out (driver : R -> (R -> R) -> Prop) a b c : Prop :=
    let w := Rabs (value W Speed_lat b now) in
    w <> 0 /\ in_way a b /\ in_way a c /\ gap a b >= 0 /\ gap b c >= 0 /\ speed c <= speed a
    /\ exists x, driver w x /\ collide x (fun t => speed c * t) (gap a c) (lengths a c) 0.
  Definition careful_behind a (w : R) (x : R -> R) : Prop :=
    exists s, first (perceived by_time 0 w) 0 s
      /\ brakes_from (speed a) (later (par "cc_evaluation" + par "cc_delay") s) (par "cc_ramp") (par "cc_braking") x.

  (* --- a deceleration: b, ahead of a and in its way, brakes to a stand by what it brakes now -------------- *)
  Definition braking b : R := - value W Acceleration_lon b now.
  Definition decelerates (driver : (R -> R) -> Prop) a b : Prop :=
    braking b > 0 /\ in_way a b /\ gap a b >= 0
    /\ exists x p, driver x /\ brakes_from (speed b) (Some 0) 0 (braking b) p /\ collide x p (gap a b) (lengths a b) 0.
  (* The careful driver perceives it at once; or only hard braking, and else goes on. *)
  Definition noticed (only_hard : bool) b : Prop := if only_hard then braking b >= par "cc_hard" else braking b > 0.
  Definition careful_following only_hard a b (x : R -> R) : Prop :=
    (noticed only_hard b
     /\ brakes_from (speed a) (Some (par "cc_evaluation" + par "cc_delay")) (par "cc_ramp") (par "cc_braking") x)
    \/ (~ noticed only_hard b /\ brakes_from (speed a) None (par "cc_ramp") (par "cc_braking") x).

  (* --- RSS at its worst: from s on a accelerates by a_max for rho, and then brakes by b_min ---------------- *)
  Definition response (t : R) : R := if Rlt_dec t 0 then 0 else if Rlt_dec t (par "rho") then - par "a_max" else par "b_min".
  Definition responds a s (x : R -> R) : Prop := goes (speed a) (fun t => response (t - s)) (s :: s + par "rho" :: nil) x.
  (* in a cut-in from when the boxes are side by side; in a deceleration at once *)
  Definition rss a (y w : R) (x : R -> R) : Prop := exists s, first (fun t => y <= w * t) 0 (Some s) /\ responds a s x.
  Definition rss_following a : (R -> R) -> Prop := responds a 0.
End State.
