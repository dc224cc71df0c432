(* Formulas on samples, and what they say of a recording, which ends.  TRUSTED by readers of Monitor.v: read this
   file and Meaning.v.  No printed claim needs it.

   A recording has samples 0 ... ended - 1, sample k at the time k * dt.  `recorded` is the table of the recorded view
   (docs/explanation/formal.md) with its relations strong and weak and the convention clip; `on_grid` is the table
   of the grid view, for samples without end.  `kept` makes a world of step traces, which keep each sample until the
   next, and `written` says when a formula of Meaning.v is written in samples.  Nothing here is about proofs. *)
From Coq Require Import Reals QArith Qreals String Arith.
From Roadproof Require Import Meaning.
Open Scope nat_scope.

(* --- formulas on samples ------------------------------------------------------------------------------------ *)

(* State i: a formula about one instant, the i-th of those of which each sample says whether they are true.
   Bounds of intervals are numbers of samples; where the upper one is None there is none. *)
Inductive sampled :=
| Truth_ (b : bool)
| State (i : nat)
| Not_ (f : sampled)
| And_ (f g : sampled)
| Or_ (f g : sampled)
| Until_ (f : sampled) (lo : nat) (hi : option nat) (g : sampled)
| Eventually_ (lo : nat) (hi : option nat) (f : sampled)
| Always_ (lo : nat) (hi : option nat) (f : sampled).

(* j is in k + [lo, hi] *)
Definition among (k lo : nat) (hi : option nat) (j : nat) : Prop :=
  k + lo <= j /\ match hi with None => True | Some b => j <= k + b end.

Inductive view := Strong | Weak | Clip.
Definition opposite (v : view) : view := match v with Strong => Weak | Weak => Strong | Clip => Clip end.

Section Samples.
  Variable truth : nat -> nat -> Prop.                      (* the i-th state formula is true at sample k *)

  (* Grid view: samples have no end. *)
  Fixpoint on_grid (k : nat) (f : sampled) : Prop :=
    match f with
    | Truth_ b => b = true
    | State i => truth i k
    | Not_ f => ~ on_grid k f
    | And_ f g => on_grid k f /\ on_grid k g
    | Or_ f g => on_grid k f \/ on_grid k g
    | Until_ f lo hi g =>
        exists j, among k lo hi j /\ on_grid j g /\ forall i, k + lo <= i < j -> on_grid i f
    | Eventually_ lo hi f => exists j, among k lo hi j /\ on_grid j f
    | Always_ lo hi f => forall j, among k lo hi j -> on_grid j f
    end.

  Variable ended : nat.                                     (* how many samples the recording has *)

  (* Strong and Weak look at all samples: after the end Strong holds of no formula, and Weak of every one.
     Clip looks at those of the recording only. *)
  Definition counts (v : view) (j : nat) : Prop := match v with Clip => j < ended | _ => True end.
  Definition after_the_end (v : view) : Prop := match v with Weak => True | _ => False end.

  Fixpoint recorded (v : view) (k : nat) (f : sampled) : Prop :=
    if k <? ended then
      match f with
      | Truth_ b => b = true
      | State i => truth i k
      | Not_ f => ~ recorded (opposite v) k f
      | And_ f g => recorded v k f /\ recorded v k g
      | Or_ f g => recorded v k f \/ recorded v k g
      | Until_ f lo hi g =>
          exists j, among k lo hi j /\ counts v j /\ recorded v j g
                    /\ forall i, k + lo <= i < j -> recorded v i f
      | Eventually_ lo hi f => exists j, among k lo hi j /\ counts v j /\ recorded v j f
      | Always_ lo hi f => forall j, among k lo hi j -> counts v j -> recorded v j f
      end
    else after_the_end v.
End Samples.

(* What a monitor answers of a formula at a sample, and when it is right. *)
Inductive verdict := Yes | No | Undecided.
Definition right_answer (truth : nat -> nat -> Prop) (ended k : nat) (f : sampled) (a : verdict) : Prop :=
  match a with
  | Yes => recorded truth ended Strong k f
  | No => ~ recorded truth ended Weak k f
  | Undecided => ~ recorded truth ended Strong k f /\ recorded truth ended Weak k f
  end.

(* --- worlds of samples -------------------------------------------------------------------------------------- *)

Open Scope R_scope.

Section Worlds.
  Variable W : world.
  Variable dt : Q.
  Definition time_of (k : nat) : R := INR k * Q2R dt.

  (* The world in which all stays for dt as it is at the last multiple of dt. *)
  Definition last_sample (t : R) : R := IZR (Int_part (t / Q2R dt)) * Q2R dt.
  Definition kept : world := {|
    element := element W;
    somewhere := somewhere W;
    parameter := parameter W;
    variable := variable W;
    value := fun n a t => value W n a (last_sample t);
    measure := measure W;
    measure_positive := measure_positive W;
    shape := shape W;
    adjacent := adjacent W;
    adjacent_irreflexive := adjacent_irreflexive W;
    adjacent_symmetric := adjacent_symmetric W;
    lanelets := lanelets W;
    lanelets_reflexive := lanelets_reflexive W;
    zone_of := zone_of W |}.

  (* A formula about one instant *)
  Fixpoint instant (f : formula) : Prop :=
    match f with
    | Truth _ | Compare _ _ _ | Occupies _ _ => True
    | Some_ _ _ f | Every _ _ f | Not f => instant f
    | And f g | Or f g => instant f /\ instant g
    | Until _ _ _ _ | Eventually _ _ _ | Always _ _ _ => False
    end.

  (* The bound of an interval is n steps, whatever the time. *)
  Definition lasts (x : term) (n : nat) : Prop := forall t, number W t x = time_of n.
  Definition last_at_most (x : option term) (n : option nat) : Prop :=
    match x, n with None, None => True | Some x, Some n => lasts x n | _, _ => False end.

  (* A formula is written in samples; `states i` is the i-th formula about one instant. *)
  Variable states : nat -> formula.
  Fixpoint written (f : formula) (s : sampled) {struct s} : Prop :=
    match s with
    | State i => f = states i /\ instant f
    | Truth_ b => f = Truth b
    | Not_ s => match f with Not f => written f s | _ => False end
    | And_ s r => match f with And f g => written f s /\ written g r | _ => False end
    | Or_ s r => match f with Or f g => written f s /\ written g r | _ => False end
    | Until_ s a b r =>
        match f with
        | Until f lo hi g => written f s /\ lasts lo a /\ last_at_most hi b /\ written g r
        | _ => False
        end
    | Eventually_ a b s =>
        match f with Eventually lo hi f => lasts lo a /\ last_at_most hi b /\ written f s | _ => False end
    | Always_ a b s =>
        match f with Always lo hi f => lasts lo a /\ last_at_most hi b /\ written f s | _ => False end
    end.

  (* What is true of the world at its samples *)
  Variable named : string -> element W.
  Definition at_samples (i k : nat) : Prop := holds W named (unbound W) (time_of k) (states i).
End Worlds.
