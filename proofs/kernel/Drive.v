(* A drive, or a trace in steps, as a world.  TRUSTED: read this file, Meaning.v, Text.v and the printed drive and claim.

   A drive file (docs/schema/drive.json) has a road of rectangles and vehicles that are boxes: where they are at
   time 0, how fast, and jerks that are constant in pieces, the last 0 for ever; and signals in steps.  In a trace
   that refutes a claim all signals are in steps, and may repeat for ever.  `world_of` says what the
   signals, sizes, lanes and parameters of such a drive are, and `shows` when a claim is true of it.  Lengths are
   in m and times in s; s grows along the road, d to the left.  Nothing here is about proofs. *)
From Coq Require Import Reals QArith Qreals String List Bool Arith.
From Roadproof Require Import Meaning.
Import ListNotations.
Open Scope R_scope.

(* --- what a file says ----------------------------------------------------------------------------------- *)

(* A motion along or across the road: place and speed at time 0; piece by piece a duration, the acceleration at its
   begin and the jerk that is kept for it; the acceleration after them. *)
Record course := { starts_at : Q; starts_with : Q; pieces : list (Q * Q * Q); finally : Q }.

(* A box, of which the front left corner moves, and what kind of vehicle it is. *)
Inductive sort := car | truck | bus | motorcycle | other.
Record body := {
  is_a : sort;
  long : Q;
  wide : Q;
  long_above_0 : (0 < long)%Q;
  wide_above_0 : (0 < wide)%Q;
  along : course;
  across : course }.

(* A rectangle of the road, which may have no begin or no end. *)
Record rectangle := {
  lane : string;
  lies_in : zone;
  from_s : option Q;
  to_s : option Q;
  right_d : Q;
  left_d : Q }.

(* `bodies`: the vehicles by name.  The road has at least one rectangle.  `beside`: which lanes are beside each
   other, in any order.  `lanes_named`: the lane that a name in the claim stands for.  `values`: parameters.
   `signals`: those that are in steps, each of a vehicle, in the order of time: a time, the value at it, and the value
   after it and before the next.  `numbers`: those that the claim speaks of.  `repeats`: a start and a period, where
   from the start on the signals of a trace repeat. *)
Record drive := {
  bodies : list (vehicle * body);
  first_rectangle : rectangle;
  other_rectangles : list rectangle;
  beside : list (string * string);
  lanes_named : list (string * string);
  values : list (string * Q);
  signals : list (signal * vehicle * list (Q * Q * Q));
  numbers : list (string * Q);
  repeats : option (Q * Q) }.

Definition look_up {A} (x : string) (l : list (string * A)) (otherwise : A) : A :=
  match find (fun entry => String.eqb x (fst entry)) l with Some entry => snd entry | None => otherwise end.

(* --- how vehicles move ---------------------------------------------------------------------------------- *)

Record instant := { place_ : R; speed_ : R; acceleration_ : R; jerk_ : R }.

(* t seconds after place x, speed v and acceleration a, under the jerk j *)
Definition moved (x v a j t : R) : instant :=
  {| place_ := x + v * t + a * t ^ 2 / 2 + j * t ^ 3 / 6;
     speed_ := v + a * t + j * t ^ 2 / 2;
     acceleration_ := a + j * t;
     jerk_ := j |}.

(* t seconds after place x and speed v, in pieces: at the instant at which a piece ends, acceleration and jerk are
   those of the next one. *)
Fixpoint moving (x v : R) (pieces : list (Q * Q * Q)) (finally : Q) (t : R) : instant :=
  match pieces with
  | [] => moved x v (Q2R finally) 0 t
  | (duration, a, j) :: rest =>
      if Rlt_dec t (Q2R duration) then moved x v (Q2R a) (Q2R j) t
      else let end_ := moved x v (Q2R a) (Q2R j) (Q2R duration) in
           moving (place_ end_) (speed_ end_) rest finally (t - Q2R duration)
  end.
Definition at_time (c : course) (t : R) : instant :=
  moving (Q2R (starts_at c)) (Q2R (starts_with c)) (pieces c) (finally c) t.

(* A signal in steps: its first value also before, its last for ever. *)
Fixpoint stepped (before : Q) (steps : list (Q * Q * Q)) (t : R) : Q :=
  match steps with
  | [] => before
  | (time, at_it, after) :: rest =>
      if Rlt_dec t (Q2R time) then before else if Req_EM_T t (Q2R time) then at_it else stepped after rest t
  end.
Definition first_step (steps : list (Q * Q * Q)) : Q := match steps with [] => 0%Q | (_, x, _) :: _ => x end.
Definition same_signal (m n : signal) : {m = n} + {m <> n}.
Proof. decide equality; apply string_dec. Defined.

(* --- the world ------------------------------------------------------------------------------------------ *)

(* A vehicle that the file does not have stands still at 0. *)
Definition still : course := {| starts_at := 0; starts_with := 0; pieces := []; finally := 0 |}.
Definition nobody : body :=
  {| is_a := other; long := 1; wide := 1; long_above_0 := eq_refl; wide_above_0 := eq_refl; along := still; across := still |}.

Section World.
  Variable D : drive.

  Definition body_of (a : vehicle) : body := look_up a (bodies D) nobody.
  Definition steps_of (n : signal) (a : vehicle) : option (list (Q * Q * Q)) :=
    option_map snd
      (find (fun e => if same_signal n (fst (fst e)) then String.eqb a (snd (fst e)) else false) (signals D)).
  (* A signal of a specification that the file does not have is 0. *)
  Definition moved_to (n : signal) (a : vehicle) (t : R) : R :=
    match n with
    | Place_lon => place_ (at_time (along (body_of a)) t)
    | Place_lat => place_ (at_time (across (body_of a)) t)
    | Speed_lon => speed_ (at_time (along (body_of a)) t)
    | Speed_lat => speed_ (at_time (across (body_of a)) t)
    | Acceleration_lon => acceleration_ (at_time (along (body_of a)) t)
    | Acceleration_lat => acceleration_ (at_time (across (body_of a)) t)
    | Jerk_lon => jerk_ (at_time (along (body_of a)) t)
    | Own n => 0
    end.
  (* The time in the first round that is like t. *)
  Definition folded (t : R) : R :=
    match repeats D with
    | None => t
    | Some (start, period) =>
        if Rlt_dec t (Q2R start) then t else t - IZR (Int_part ((t - Q2R start) / Q2R period)) * Q2R period
    end.
  Definition value_of (n : signal) (a : vehicle) (t : R) : R :=
    match steps_of n a with
    | Some steps => Q2R (stepped (first_step steps) steps (folded t))
    | None => moved_to n a (folded t)
    end.
  Definition number_of_sort (k : sort) : Q :=
    match k with car => 1 | truck => 2 | bus => 3 | motorcycle => 4 | other => 5 end.
  Definition measure_of (n : size) (a : vehicle) : R :=
    match n with
    | Length => Q2R (long (body_of a))
    | Width => Q2R (wide (body_of a))
    | Kind => Q2R (number_of_sort (is_a (body_of a)))
    end.

  (* An element of the road is the number of a rectangle.  It stands for a lanelet, and for its lane as well. *)
  Definition rectangles : list rectangle := first_rectangle D :: other_rectangles D.
  Definition element_of : Type := { k : nat | Nat.ltb k (List.length rectangles) = true }.
  Definition first_element : element_of := exist _ 0%nat eq_refl.
  Definition element_number (k : nat) : element_of :=
    match bool_dec (Nat.ltb k (List.length rectangles)) true with left H => exist _ k H | right _ => first_element end.
  Definition rectangle_of (e : element_of) : rectangle := nth (proj1_sig e) rectangles (first_rectangle D).
  Definition lane_of (e : element_of) : string := lane (rectangle_of e).

  Definition shape_of (e : element_of) : extent :=
    {| s_from := option_map Q2R (from_s (rectangle_of e)); s_to := option_map Q2R (to_s (rectangle_of e));
       d_from := Q2R (right_d (rectangle_of e)); d_to := Q2R (left_d (rectangle_of e)) |}.

  Definition are_beside (e f : element_of) : Prop :=
    lane_of e <> lane_of f
    /\ (In (lane_of e, lane_of f) (beside D) \/ In (lane_of f, lane_of e) (beside D)).

  (* A parameter without a value is 0, and so is a number without one. *)
  Definition parameter_of (p : string) : R := Q2R (look_up p (values D) 0%Q).
  Definition variable_of (x : string) : R := Q2R (look_up x (numbers D) 0%Q).

  Lemma measure_of_positive n a : 0 < measure_of n a.
  Proof.
    replace 0 with (Q2R 0) by (unfold Q2R; simpl; apply Rmult_0_l).
    destruct n; apply Qlt_Rlt; [apply long_above_0|apply wide_above_0|].
    unfold number_of_sort. destruct (is_a (body_of a)); reflexivity.
  Qed.
  Lemma are_beside_irreflexive e : ~ are_beside e e.
  Proof. intros [H _]. apply H. reflexivity. Qed.
  Lemma are_beside_symmetric e f : are_beside e f -> are_beside f e.
  Proof. intros [H [I|I]]; (split; [intros E; apply H; symmetry; exact E|tauto]). Qed.

  Definition world_of : world := {|
    element := element_of;
    somewhere := first_element;
    parameter := parameter_of;
    variable := variable_of;
    value := value_of;
    measure := measure_of;
    measure_positive := measure_of_positive;
    shape := shape_of;
    adjacent := are_beside;
    adjacent_irreflexive := are_beside_irreflexive;
    adjacent_symmetric := are_beside_symmetric;
    lanelets := fun e f => lane_of e = lane_of f;
    lanelets_reflexive := fun e => eq_refl;
    zone_of := fun e => lies_in (rectangle_of e) |}.

  (* What a name such as L stands for: the first rectangle of the lane that the file says. *)
  Fixpoint first_of (x : string) (l : list rectangle) : nat :=
    match l with [] => 0 | r :: l => if String.eqb (lane r) x then 0 else S (first_of x l) end%nat.
  Definition element_named (x : string) : element_of :=
    element_number (first_of (look_up x (lanes_named D) ""%string) rectangles).

  (* The claim is true of the drive at time 0, and the parameters are within their bounds. *)
  Definition shows (bounds : list bound) (claim : formula) : Prop :=
    respects world_of bounds /\ holds world_of element_named (unbound world_of) 0 claim.
End World.
