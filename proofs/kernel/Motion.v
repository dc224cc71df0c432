(* What a motion is.  TRUSTED: read this file, Meaning.v, Text.v and the printed claim, where it assumes motion.

   In a world of Meaning.v signals are any functions of time, and may jump.  In a motion a position is the integral
   of a speed, and a speed that of an acceleration (docs/explanation/motion.md).  Sizes and parameters have one value
   at all times in every world.  The integral is Riemann's, of Coq's own library, so that no other (Coquelicot) has to
   be installed: accelerations are bounded in bounded time, and may jump.  Times are from 0 on.  Nothing here is about
   proofs. *)
From Coq Require Import Reals String List.
From Roadproof Require Import Meaning.
Open Scope R_scope.

(* The rate of change of a signal; those that have none here may jump. *)
Definition rate_of (n : signal) : option signal :=
  match n with
  | Place_lon => Some Speed_lon
  | Place_lat => Some Speed_lat
  | Speed_lon => Some Acceleration_lon
  | Speed_lat => Some Acceleration_lat
  | _ => None
  end.

(* From s to t, F grows by the integral of f. *)
Definition is_integral (F f : R -> R) : Prop :=
  forall s t, 0 <= s <= t -> exists integrable : Riemann_integrable f s t, F t - F s = RiemannInt integrable.

(* What is true at an instant is true for a while before and after it. *)
Definition lingers (p : R -> Prop) : Prop :=
  forall t, 0 <= t -> p t -> exists while, 0 < while /\ forall u, 0 <= u -> t - while < u < t + while -> p u.

(* A vehicle is in a lanelet where the insides of its box and of the lanelet overlap.  The box moves as its position
   does and the lanelet stands still, so that one that overlap go on to overlap for a while.  There are finitely many
   lanelets. *)
Record motion (W : world) : Prop := {
  grows : forall n rate a, rate_of n = Some rate -> is_integral (value W n a) (value W rate a);
  overlaps : forall a l, lingers (occupies W a l);
  finite : exists road : list (element W), forall l, In l road }.

(* The claim holds at time 0 in every motion, for all parameters within their bounds. *)
Definition valid_of_motions (bounds : list bound) (claim : formula) : Prop :=
  forall (W : world) (named : string -> element W),
    motion W -> respects W bounds -> holds W named (unbound W) 0 claim.
