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

(* There are finitely many lanelets.  That a vehicle which occupies one goes on to do so for a while follows from
   Meaning.v (`overlaps` in Integral.v). *)
Record motion (W : world) : Prop := {
  grows : forall n rate a, rate_of n = Some rate -> is_integral (value W n a) (value W rate a);
  finite : exists road : list (element W), forall l, In l road }.

(* The claim holds at time 0 in every motion, for all parameters within their bounds. *)
Definition valid_of_motions (bounds : list bound) (claim : formula) : Prop :=
  forall (W : world) (named : string -> element W),
    motion W -> respects W bounds -> holds W named (unbound W) 0 claim.
