(* Tableaux, reasons, derivations and trees as data of checker.ml.  NOT TRUSTED: whatever they are read as is checked. *)
open Checker
open Reader

(* --- Tableau.v ----------------------------------------------------------------------------------------- *)

let row = list q
let multiplier = function Node [ Word "by_"; n; k ] -> (nat n, q k) | _ -> unread "a multiplier"
let sum = list multiplier

let rec tree = function
  | Node [ Word "CloseTruth"; i ] -> CloseTruth (nat i)
  | Node [ Word "Close"; i; j; v; w ] -> Close (nat i, nat j, sum v, sum w)
  | Node [ Word "CloseLinear"; w ] -> CloseLinear (sum w)
  | Node [ Word "CloseRoad"; i ] -> CloseRoad (nat i)
  | Node [ Word "CloseRoads"; i; j ] -> CloseRoads (nat i, nat j)
  | Node [ Word "CloseZones"; i; j; k ] -> CloseZones (nat i, nat j, nat k)
  | Node [ Word "Alpha"; i; t ] -> Alpha (nat i, tree t)
  | Node [ Word "Beta"; i; t; u ] -> Beta (nat i, tree t, tree u)
  | Node [ Word "Timing"; i; t ] -> Timing (nat i, tree t)
  | Node [ Word "New"; i; n; t ] -> New (nat i, nat n, tree t)
  | Node [ Word "Inst"; i; m; v; w; t ] -> Inst (nat i, row m, sum v, sum w, tree t)
  | Node [ Word "InstUntil"; i; m; v; w; n; t; u ] ->
      InstUntil (nat i, row m, sum v, sum w, nat n, tree t, tree u)
  | Node [ Word "NewRoad"; i; c; t ] -> NewRoad (nat i, name c, tree t)
  | Node [ Word "InstRoad"; i; c; t; u ] -> InstRoad (nat i, name c, tree t, tree u)
  | Node [ Word "Cut"; v; t; u ] -> Cut (row v, tree t, tree u)
  | Node [ Word "Fact"; k; m; t ] -> Fact (nat k, row m, tree t)
  | _ -> unread "a tableau"

(* --- Products.v ---------------------------------------------------------------------------------------- *)

let rec poly = function
  | Node [ Word "c_"; n; d ] -> c_ (z n) (positive d)
  | Node [ Word "x_"; n ] -> x_ (positive n)
  | Node [ Word "add_"; p; r ] -> PEadd (poly p, poly r)
  | Node [ Word "mul_"; p; r ] -> PEmul (poly p, poly r)
  | _ -> unread "a polynomial"

let rec products = function
  | Node [ Word "given_"; i ] -> given_ (nat i)
  | Node [ Word "number_"; n; d ] -> number_ (z n) (positive d)
  | Node [ Word "square_"; p ] -> square_ (poly p)
  | Node [ Word "times_"; p; w ] -> times_ (poly p) (products w)
  | Node [ Word "product_"; v; w ] -> PsatzMulE (products v, products w)
  | Node [ Word "sum_"; v; w ] -> PsatzAdd (products v, products w)
  | _ -> unread "a sum of products"

let rec reason = function
  | Node [ Word "Absurd"; w ] -> Absurd (products w)
  | Node [ Word "Untrue"; i ] -> Untrue (nat i)
  | Node [ Word "Opposed"; i; j ] -> Opposed (nat i, nat j)
  | Node [ Word "Both"; i; r ] -> Both (nat i, reason r)
  | Node [ Word "Either"; i; r; s ] -> Either (nat i, reason r, reason s)
  | Node [ Word "Plain"; i; r ] -> Plain (nat i, reason r)
  | Node [ Word "Reads"; i; r ] -> Reads (nat i, reason r)
  | Node [ Word "Sized"; n; a; r ] -> Sized (size n, name a, reason r)
  | Node [ Word "Largest"; x; y; r; s ] -> Largest (term x, term y, reason r, reason s)
  | Node [ Word "Smallest"; x; y; r; s ] -> Smallest (term x, term y, reason r, reason s)
  | Node [ Word "Over"; x; y; up; w; r ] -> Over (term x, term y, bool up, products w, reason r)
  | Node [ Word "Sign"; p; r; s ] -> Sign (poly p, reason r, reason s)
  | _ -> unread "a reason"

(* --- Shown.v; constructors that Products.v has too end in 0 -------------------------------------------- *)

let moment = function
  | Node [ Word "Fixed"; u ] -> Fixed (q u)
  | Node [ Word "Later"; u ] -> Later (q u)
  | _ -> unread "a moment"

let rec derivation = function
  | Word "Plain" -> Plain0
  | Node [ Word "Sign"; l ] -> Sign0 (list q l)
  | Node [ Word "Turn"; p ] -> Turn (derivation p)
  | Node [ Word "Both"; p; r ] -> Both0 (derivation p, derivation r)
  | Node [ Word "One"; b; p ] -> One (bool b, derivation p)
  | Node [ Word "Split"; c; b; p; r ] -> Split (q c, bool b, derivation p, derivation r)
  | Node [ Word "Case"; l; p; r ] -> Case (list q l, derivation p, derivation r)
  | Node [ Word "Element"; e; p ] -> Element (nat e, derivation p)
  | Node [ Word "Each"; l ] -> Each (list derivation l)
  | Node [ Word "Whole"; p ] -> Whole (derivation p)
  | Node [ Word "Moment"; m; p ] -> Moment (moment m, derivation p)
  | Node [ Word "Reach"; m; p; r ] -> Reach (moment m, derivation p, derivation r)
  | Node [ Word "Break"; m; p; r ] -> Break (moment m, derivation p, derivation r)
  | Node [ Word "Soon"; c; d; p; r ] -> Soon (q c, q d, derivation p, derivation r)
  | Node [ Word "Crossing"; a; b; s; before; between; at ] ->
      Crossing (q a, q b, list q s, derivation before, derivation between, derivation at)
  | Node [ Word "Earlier"; n; p ] -> Earlier (nat n, derivation p)
  | Node [ Word "Round"; p ] -> Round (derivation p)
  | _ -> unread "a derivation"

(* --- Refuted.v ----------------------------------------------------------------------------------------- *)

let fact = function
  | Node [ Word "Equal"; n ] -> Equal0 (positive n)
  | Node [ Word "Above"; n ] -> Above (positive n)
  | Node [ Word "Known"; n ] -> Known (positive n)
  | Node [ Word "Corner"; k; first; second ] -> Corner (positive k, bool first, bool second)
  | Node [ Word "Tangent"; k; at ] -> Tangent (positive k, z at)
  | _ -> unread "a fact about a program"

let multiple = function Node [ Word "a_multiple"; f; w ] -> (fact f, z w) | _ -> unread "a multiple of a fact"

let rec refutation = function
  | Node [ Word "Sum"; l ] -> Sum (list multiple l)
  | Node [ Word "Cases"; n; l ] -> Cases (positive n, refutations l)
  | Node [ Word "Cut"; k; at; low; high ] -> Cut0 (positive k, z at, refutation low, refutation high)
  | _ -> unread "a tree"

and refutations = function
  | Word "Done" -> Done
  | Node [ Word "More"; t; l ] -> More (refutation t, refutations l)
  | _ -> unread "trees"
