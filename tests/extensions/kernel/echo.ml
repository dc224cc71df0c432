(* Formulas, drives and programs that reader.ml has read, as constructors of Meaning.v in the words of raw.py
   and test_extracted.py. *)
open Checker
open Reader

let rec int_of = function XH -> 1 | XO p -> 2 * int_of p | XI p -> (2 * int_of p) + 1
let z_ = function Z0 -> "0" | Zpos p -> string_of_int (int_of p) | Zneg p -> "-" ^ string_of_int (int_of p)
let q_ x = Printf.sprintf "(Qmake (%s) %d)" (z_ x.qnum) (int_of x.qden)
let text x = Printf.sprintf "\"%s\"%%string" (String.of_seq (List.to_seq x))
let rec int_of_nat = function O -> 0 | S n -> 1 + int_of_nat n
let nat_ n = Printf.sprintf "%d%%nat" (int_of_nat n)
let node words = "(" ^ String.concat " " words ^ ")"

let signal_ = function
  | Place_lon -> "Place_lon" | Place_lat -> "Place_lat" | Speed_lon -> "Speed_lon" | Speed_lat -> "Speed_lat"
  | Acceleration_lon -> "Acceleration_lon" | Acceleration_lat -> "Acceleration_lat"
  | Jerk_lon -> "Jerk_lon" | Own x -> node [ "Own"; text x ]

let size_ = function Length -> "Length" | Width -> "Width" | Kind -> "Kind"

let rec term_ = function
  | Num x -> node [ "Num"; q_ x ]
  | Par x -> node [ "Par"; text x ]
  | Var x -> node [ "Var"; text x ]
  | Sig (n, a) -> node [ "Sig"; signal_ n; text a ]
  | Siz (n, a) -> node [ "Siz"; size_ n; text a ]
  | Add (x, y) -> node [ "Add"; term_ x; term_ y ]
  | Mul (x, y) -> node [ "Mul"; term_ x; term_ y ]
  | Pow (x, n) -> node [ "Pow"; term_ x; nat_ n ]
  | Div (x, y) -> node [ "Div"; term_ x; term_ y ]
  | Max (x, y) -> node [ "Max"; term_ x; term_ y ]
  | Min (x, y) -> node [ "Min"; term_ x; term_ y ]

let side_ = function Fin x -> node [ "Fin"; term_ x ] | Inv x -> node [ "Inv"; term_ x ]
let comparison_ = function LT -> "LT" | LE -> "LE" | GT -> "GT" | GE -> "GE"
let road_ = function Free x -> node [ "Free"; text x ] | Bound n -> node [ "Bound"; nat_ n ]
let zone_ = function Main -> "main" | Merge -> "merge" | Depart -> "depart"

let domain_ = function
  | Lanes -> "Lanes"
  | Adjacent l -> node [ "Adjacent"; road_ l ]
  | Lanelets l -> node [ "Lanelets"; road_ l ]
  | Zone x -> node [ "Zone"; zone_ x ]

let high_ = function None -> "None" | Some x -> node [ "Some"; term_ x ]

let rec formula_ = function
  | Truth b -> node [ "Truth"; string_of_bool b ]
  | Compare (l, o, r) -> node [ "Compare"; side_ l; comparison_ o; side_ r ]
  | Occupies (a, l) -> node [ "Occupies"; text a; road_ l ]
  | Some_ (n, d, f) -> node [ "Some_"; nat_ n; domain_ d; formula_ f ]
  | Every (n, d, f) -> node [ "Every"; nat_ n; domain_ d; formula_ f ]
  | Not f -> node [ "Not"; formula_ f ]
  | And (f, g) -> node [ "And"; formula_ f; formula_ g ]
  | Or (f, g) -> node [ "Or"; formula_ f; formula_ g ]
  | Until (f, lo, hi, g) -> node [ "Until"; formula_ f; term_ lo; high_ hi; formula_ g ]
  | Eventually (lo, hi, f) -> node [ "Eventually"; term_ lo; high_ hi; formula_ f ]
  | Always (lo, hi, f) -> node [ "Always"; term_ lo; high_ hi; formula_ f ]

(* Bounds as At_least_0 and Above_0; bodies and rectangles field by field. *)
let bound_ = function
  | At_least_0 p -> node [ "at_least_0"; text p ]
  | Above_0 p -> node [ "above_0"; text p ]
  | Own_at_least (n, a, x) -> node [ "own_at_least"; text n; text a; q_ x ]
  | Own_at_most (n, a, x) -> node [ "own_at_most"; text n; text a; q_ x ]

let all show l = "[" ^ String.concat "; " (List.map show l) ^ "]"
let pair_ show show' (x, y) = node [ show x; show' y ]
let piece_ ((d, a), j) = node [ q_ d; q_ a; q_ j ]
let course_ c = node [ q_ c.starts_at; q_ c.starts_with; all piece_ c.pieces; q_ c.finally ]
let sort_ = function Car -> "car" | Truck -> "truck" | Bus -> "bus" | Motorcycle -> "motorcycle" | Other -> "other"
let body_ (a, b) = node [ text a; sort_ b.is_a; q_ b.long; q_ b.wide; course_ b.along; course_ b.across ]
let step_ ((time, x), after) = node [ q_ time; q_ x; q_ after ]
let steps_ ((n, a), l) = node [ signal_ n; text a; all step_ l ]
let end__ = function None -> "None" | Some x -> q_ x

let rectangle_ r =
  node [ text r.lane; zone_ r.lies_in; end__ r.from_s; end__ r.to_s; q_ r.right_d; q_ r.left_d ]

let repetition_ = function None -> "None" | Some x -> pair_ q_ q_ x

let drive_ d =
  node
    [ all body_ d.bodies; all rectangle_ (d.first_rectangle :: d.other_rectangles); all (pair_ text text) d.beside;
      all (pair_ text text) d.lanes_named; all (pair_ text q_) d.values0; all steps_ d.signals;
      all (pair_ text q_) d.numbers; repetition_ d.repeats ]

let column_ (k, (low, high)) = node [ z_ (Zpos k); z_ low; z_ high ]
let product_ (k, (i, j)) = node (List.map (fun n -> z_ (Zpos n)) [ k; i; j ])
let factor_ (k, c) = node [ z_ (Zpos k); z_ c ]
let row_ (n, (terms, constant)) = node [ z_ (Zpos n); all factor_ terms; z_ constant ]
let numbers_ = all (fun n -> z_ (Zpos n))

let node_ (n, x) =
  node
    (z_ (Zpos n)
    ::
    (match x with
    | Holds (strict, (terms, c)) -> [ (if strict then "above" else "at_least"); all factor_ terms; z_ c ]
    | Every0 parts -> [ "all"; numbers_ parts ]
    | Either0 parts -> [ "one"; numbers_ parts ]))

let program_ p =
  node
    [ z_ p.scale; all column_ p.columns; all product_ p.products; all row_ p.equal; all row_ p.above2;
      all node_ p.nodes; z_ (Zpos p.condition) ]

let said = function
  | Node [ Word "formula"; given; f ] -> formula_ (formula (definitions given) f)
  | Node [ Word "bounds"; l ] -> all bound_ (list bound l)
  | Node [ Word "drive"; x ] -> drive_ (drive x)
  | Node [ Word "program"; a; b; c; d; e; f; g ] -> program_ (program a b c d e f g)
  | _ -> unread "a form of echo.ml"

let () = List.iter (fun x -> print_endline (try said x with Unread what -> "unread " ^ what)) (forms (read_line ()))
