(* The text of a claim with its certificate, as data of checker.ml.  TRUSTED: a wrong reader would check another
   claim than the one that is written.

   A file is a sequence of forms, of which each stands alone:

     (proof NAME TEXT BOUNDS DEFINITIONS CLAIM LEMMAS PARAMETERS VALUES TABLEAU)
     (motions NAME TEXT BOUNDS DEFINITIONS CLAIM SCHEMAS SUPPOSED LEMMAS PARAMETERS VALUES TABLEAU)
     (traces ...), as motions
     (drive NAME TEXT BOUNDS DEFINITIONS CLAIM DRIVE DERIVATION)
     (none_within NAME TEXT PROGRAMS): that no program of them has a solution

   NAME names the form in the verdict.  TEXT, a string, is the claim as roadproof writes it; nothing reads it.
   BOUNDS, CLAIM, TABLEAU, DERIVATION and all inside are written as Coq writes data without notations: the name
   of a constructor of Meaning.v, Tableau.v, Products.v or Shown.v, then its arguments.
     brackets   (Not f) is one argument; [x; y] is a list
     numbers    5, (3 # 4), (q 3 4): whole numbers in decimal, the lower one above 0
     strings    "SV"; a quotation mark inside is written twice
     DEFINITIONS  a list of (NAME FORMULA), NAME a string; later a string in place of a formula means it
     SCHEMAS    a list of instances of Schemas.v; SUPPOSED is the claim with them as premises, which TABLEAU shows.
                motions says that the claim holds of motions, traces that it is valid, by inductions alone
     LEMMAS     a list of (FORMULA TERMS REASON), where TERMS are the variables of the polynomials of REASON, or
                (FORMULA known) for a fact of Known.v
     PARAMETERS a list of strings: those that moments speak of, in the order of their numbers
     VALUES     a list of (NAME NUMBER): values of parameters that the claim demands (Values.v)
     DRIVE      (BODIES RECTANGLES BESIDE LANES VALUES SIGNALS NUMBERS REPEATS), the fields of `drive` in Drive.v:
                a body is (NAME SORT LONG WIDE ALONG ACROSS),
                a course is (PLACE SPEED [(SECONDS ACCELERATION JERK)] ACCELERATION),
                a rectangle is (LANE ZONE FROM TO RIGHT LEFT) with None for no end,
                a signal is (SIGNAL VEHICLE [(TIME VALUE AFTER)]),
                and REPEATS is (START PERIOD) or None
     PROGRAMS   a list of (SCALE COLUMNS PRODUCTS EQUAL ABOVE NODES CONDITION TREE): the fields of `program` in
                Programs.v, whose entries are written with its functions, such as (a_column 1 0 40), and a tree
                of Refuted.v *)
open Checker

type text = Word of string | Quoted of string | Node of text list | List of text list

exception Unread of string

let unread what = raise (Unread what)

(* --- tokens and brackets ------------------------------------------------------------------------------- *)

let blank c = c = ' ' || c = '\n'
let plain c = not (blank c || String.contains "()[];\"" c)

let rec quoted s i found =
  match String.index_from_opt s i '"' with
  | None -> unread "a string without end"
  | Some j ->
      let found = found ^ String.sub s i (j - i) in
      if j + 1 < String.length s && s.[j + 1] = '"' then quoted s (j + 2) (found ^ "\"") else (found, j + 1)

let rec word s i = if i < String.length s && plain s.[i] then word s (i + 1) else i

(* The texts up to a closing bracket or the end of the string, and where that is. *)
let rec texts s i found =
  if i >= String.length s then (List.rev found, i)
  else
    match s.[i] with
    | c when blank c -> texts s (i + 1) found
    | ')' | ']' | ';' -> (List.rev found, i)
    | '"' -> let x, i = quoted s (i + 1) "" in texts s i (Quoted x :: found)
    | '(' -> let x, i = node s (i + 1) in texts s i (x :: found)
    | '[' -> let x, i = items s (i + 1) [] in texts s i (List x :: found)
    | _ -> let j = word s i in texts s j (Word (String.sub s i (j - i)) :: found)

and node s i =
  let inside, i = texts s i [] in
  if i < String.length s && s.[i] = ')' then (single inside, i + 1) else unread "a bracket without end"

and items s i found =
  let inside, i = texts s i [] in
  let found = if inside = [] then found else single inside :: found in
  if i >= String.length s then unread "a list without end"
  else match s.[i] with ';' -> items s (i + 1) found | ']' -> (List.rev found, i + 1) | _ -> unread "brackets that do not match"

and single inside = match inside with [ x ] -> x | _ -> Node inside

let forms s =
  let found, i = texts s 0 [] in
  if i < String.length s then unread "a bracket too many" else found

(* --- numbers and names --------------------------------------------------------------------------------- *)

let rec positive_int n = if n = 1 then XH else if n land 1 = 1 then XI (positive_int (n / 2)) else XO (positive_int (n / 2))
let small n = if n = 0 then Z0 else Zpos (positive_int n)
let ten = small 10
let digit c = if c >= '0' && c <= '9' then small (Char.code c - 48) else unread "a number"

let whole s =
  let from = if s <> "" && s.[0] = '-' then 1 else 0 in
  if String.length s = from then unread "a number"
  else
    let found = ref Z0 in
    String.iteri (fun i c -> if i >= from then found := Z.add (Z.mul !found ten) (digit c)) s;
    if from = 1 then Z.opp !found else !found

let z = function Word s -> whole s | _ -> unread "a whole number"
let positive x = match z x with Zpos p -> p | _ -> unread "a whole number above 0"

let q = function
  | Word s -> { qnum = whole s; qden = XH }
  | Node [ Word "q"; n; d ] | Node [ n; Word "#"; d ] -> { qnum = z n; qden = positive d }
  | _ -> unread "a number"

let rec nat_of n = if n = 0 then O else S (nat_of (n - 1))

let nat = function
  | Word s when s <> "" && String.length s <= 5 -> String.iter (fun c -> ignore (digit c)) s; nat_of (int_of_string s)
  | _ -> unread "a number of a place"

let name = function Quoted s -> List.of_seq (String.to_seq s) | _ -> unread "a string"
let bool = function Word "true" -> true | Word "false" -> false | _ -> unread "true or false"
let list read = function List l -> List.map read l | _ -> unread "a list"

(* --- Meaning.v ----------------------------------------------------------------------------------------- *)

let signal = function
  | Word "Place_lon" -> Place_lon
  | Word "Place_lat" -> Place_lat
  | Word "Speed_lon" -> Speed_lon
  | Word "Speed_lat" -> Speed_lat
  | Word "Acceleration_lon" -> Acceleration_lon
  | Word "Acceleration_lat" -> Acceleration_lat
  | Word "Jerk_lon" -> Jerk_lon
  | Node [ Word "Own"; x ] -> Own (name x)
  | _ -> unread "a signal"

let size = function
  | Word "Length" -> Length
  | Word "Width" -> Width
  | Word "Kind" -> Kind
  | _ -> unread "a size"

let rec term = function
  | Node [ Word "Num"; x ] -> Num (q x)
  | Node [ Word "Par"; x ] -> Par (name x)
  | Node [ Word "Var"; x ] -> Var (name x)
  | Node [ Word "Sig"; n; a ] -> Sig (signal n, name a)
  | Node [ Word "Siz"; n; a ] -> Siz (size n, name a)
  | Node [ Word "Add"; x; y ] -> Add (term x, term y)
  | Node [ Word "Mul"; x; y ] -> Mul (term x, term y)
  | Node [ Word "Pow"; x; n ] -> Pow (term x, nat n)
  | Node [ Word "Div"; x; y ] -> Div (term x, term y)
  | Node [ Word "Max"; x; y ] -> Max (term x, term y)
  | Node [ Word "Min"; x; y ] -> Min (term x, term y)
  | _ -> unread "a term"

let side = function
  | Node [ Word "Fin"; x ] -> Fin (term x)
  | Node [ Word "Inv"; x ] -> Inv (term x)
  | _ -> unread "a side of a comparison"

let comparison = function
  | Word "LT" -> LT
  | Word "LE" -> LE
  | Word "GT" -> GT
  | Word "GE" -> GE
  | _ -> unread "a comparison"

let road = function
  | Node [ Word "Free"; x ] -> Free (name x)
  | Node [ Word "Bound"; n ] -> Bound (nat n)
  | _ -> unread "a lane"

let zone = function Word "main" -> Main | Word "merge" -> Merge | Word "depart" -> Depart | _ -> unread "a zone"

let domain = function
  | Word "Lanes" -> Lanes
  | Node [ Word "Adjacent"; l ] -> Adjacent (road l)
  | Node [ Word "Lanelets"; l ] -> Lanelets (road l)
  | Node [ Word "Zone"; x ] -> Zone (zone x)
  | _ -> unread "a domain"

let high = function Word "None" -> None | Node [ Word "Some"; x ] -> Some (term x) | _ -> unread "an end of an interval"

(* `known` holds the definitions that stand before. *)
let rec formula known = function
  | Quoted x -> (match List.assoc_opt x known with Some f -> f | None -> unread ("the formula " ^ x))
  | Node [ Word "Truth"; b ] -> Truth (bool b)
  | Node [ Word "Compare"; l; o; r ] -> Compare (side l, comparison o, side r)
  | Node [ Word "Occupies"; a; l ] -> Occupies (name a, road l)
  | Node [ Word "Some_"; n; d; f ] -> Some_ (nat n, domain d, formula known f)
  | Node [ Word "Every"; n; d; f ] -> Every (nat n, domain d, formula known f)
  | Node [ Word "Not"; f ] -> Not (formula known f)
  | Node [ Word "And"; f; g ] -> And (formula known f, formula known g)
  | Node [ Word "Or"; f; g ] -> Or (formula known f, formula known g)
  | Node [ Word "Until"; f; lo; hi; g ] -> Until (formula known f, term lo, high hi, formula known g)
  | Node [ Word "Eventually"; lo; hi; f ] -> Eventually (term lo, high hi, formula known f)
  | Node [ Word "Always"; lo; hi; f ] -> Always (term lo, high hi, formula known f)
  | _ -> unread "a formula"

let define known = function
  | Node [ Quoted x; f ] when not (List.mem_assoc x known) -> (x, formula known f) :: known
  | _ -> unread "a definition with a new name"

let definitions = function List l -> List.fold_left define [] l | _ -> unread "a list of definitions"

let bound = function
  | Node [ Word "at_least_0"; p ] -> At_least_0 (name p)
  | Node [ Word "above_0"; p ] -> Above_0 (name p)
  | Node [ Word "own_at_least"; n; a; low ] -> Own_at_least (name n, name a, q low)
  | Node [ Word "own_at_most"; n; a; high ] -> Own_at_most (name n, name a, q high)
  | _ -> unread "a bound"

(* --- Schemas.v ----------------------------------------------------------------------------------------- *)

let schema known = function
  | Node [ Word "At_most"; x; y ] -> At_most (term x, term y)
  | Node [ Word "Below"; x; y ] -> Below (term x, term y)
  | Node [ Word "Meets"; x; y ] -> Meets (term x, term y)
  | Node [ Word "Leaves"; p ] -> Leaves (formula known p)
  | Node [ Word "Within"; x; y; r; d ] -> Within (term x, term y, term r, term d)
  | Node [ Word "After"; x; y; r; d ] -> After (term x, term y, term r, term d)
  | Node [ Word "Within_twice"; x; y; v; r; d ] -> Within_twice (term x, term y, term v, term r, term d)
  | Node [ Word "After_twice"; x; y; v; r; d ] -> After_twice (term x, term y, term v, term r, term d)
  | Node [ Word "Repeats"; p; lo; hi ] -> Repeats (formula known p, term lo, term hi)
  | Node [ Word "Lasts"; p; d ] -> Lasts (formula known p, term d)
  | _ -> unread "a schema"

(* --- Drive.v ------------------------------------------------------------------------------------------- *)

let pair read read' = function Node [ x; y ] -> (read x, read' y) | _ -> unread "a pair"

let piece = function Node [ seconds; a; j ] -> ((q seconds, q a), q j) | _ -> unread "a piece"

let course = function
  | Node [ x; v; l; last ] -> { starts_at = q x; starts_with = q v; pieces = list piece l; finally = q last }
  | _ -> unread "a course"

(* Drive.v has proofs that sizes are above 0, which OCaml has not. *)
let above_0 x = match q x with { qnum = Zpos _; _ } as x -> x | _ -> unread "a size above 0"

let sort = function
  | Word "car" -> Car
  | Word "truck" -> Truck
  | Word "bus" -> Bus
  | Word "motorcycle" -> Motorcycle
  | Word "other" -> Other
  | _ -> unread "a kind of vehicle"

let body = function
  | Node [ a; k; l; w; s; d ] ->
      (name a, { is_a = sort k; long = above_0 l; wide = above_0 w; along = course s; across = course d })
  | _ -> unread "a body"

let end_ = function Word "None" -> None | x -> Some (q x)

let rectangle = function
  | Node [ l; x; from; upto; right; left ] ->
      { lane = name l; lies_in = zone x; from_s = end_ from; to_s = end_ upto; right_d = q right; left_d = q left }
  | _ -> unread "a rectangle"

let step = function Node [ time; x; after ] -> ((q time, q x), q after) | _ -> unread "a step"
let steps = function Node [ n; a; l ] -> ((signal n, name a), list step l) | _ -> unread "a signal in steps"

let repetition = function Word "None" -> None | x -> Some (pair q q x)

let drive = function
  | Node [ bodies; List (first :: others); beside; lanes; values; own; numbers; repeats ] ->
      { bodies = list body bodies; first_rectangle = rectangle first; other_rectangles = List.map rectangle others;
        beside = list (pair name name) beside; lanes_named = list (pair name name) lanes;
        values0 = list (pair name q) values; signals = list steps own;
        numbers = list (pair name q) numbers; repeats = repetition repeats }
  | _ -> unread "a drive"

(* --- Programs.v ---------------------------------------------------------------------------------------- *)

let column = function
  | Node [ Word "a_column"; k; low; high ] -> (positive k, (z low, z high))
  | _ -> unread "a column"

let product = function
  | Node [ Word "a_product"; k; i; j ] -> (positive k, (positive i, positive j))
  | _ -> unread "a product"

let a_term = function Node [ Word "a_term"; k; c ] -> (positive k, z c) | _ -> unread "a coefficient"

let row = function
  | Node [ Word "a_row"; n; terms; constant ] -> (positive n, (list a_term terms, z constant))
  | _ -> unread "a row"

let node = function
  | Node [ Word "a_leaf"; n; strict; terms; constant ] ->
      (positive n, Holds (bool strict, (list a_term terms, z constant)))
  | Node [ Word "a_conjunction"; n; parts ] -> (positive n, Every0 (list positive parts))
  | Node [ Word "a_disjunction"; n; parts ] -> (positive n, Either0 (list positive parts))
  | _ -> unread "a node"

let program scale columns products equal above nodes condition =
  { scale = z scale; columns = list column columns; products = list product products; equal = list row equal;
    above2 = list row above; nodes = list node nodes; condition = positive condition }
