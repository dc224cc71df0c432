
type __ = Obj.t

(** val xorb : bool -> bool -> bool **)

let xorb b1 b2 =
  if b1 then if b2 then false else true else b2

(** val negb : bool -> bool **)

let negb = function
| true -> false
| false -> true

type nat =
| O
| S of nat

(** val option_map : ('a1 -> 'a2) -> 'a1 option -> 'a2 option **)

let option_map f = function
| Some a -> Some (f a)
| None -> None

(** val fst : ('a1 * 'a2) -> 'a1 **)

let fst = function
| (x, _) -> x

(** val snd : ('a1 * 'a2) -> 'a2 **)

let snd = function
| (_, y) -> y

(** val length : 'a1 list -> nat **)

let rec length = function
| [] -> O
| _ :: l' -> S (length l')

(** val app : 'a1 list -> 'a1 list -> 'a1 list **)

let rec app l m =
  match l with
  | [] -> m
  | a :: l1 -> a :: (app l1 m)

type comparison =
| Eq
| Lt
| Gt

(** val compOpp : comparison -> comparison **)

let compOpp = function
| Eq -> Eq
| Lt -> Gt
| Gt -> Lt

type 'a sig0 = 'a
  (* singleton inductive, whose constructor was exist *)



module Coq__1 = struct
 (** val add : nat -> nat -> nat **)
 let rec add n0 m =
   match n0 with
   | O -> m
   | S p -> S (add p m)
end
include Coq__1

(** val sub : nat -> nat -> nat **)

let rec sub n0 m =
  match n0 with
  | O -> n0
  | S k -> (match m with
            | O -> n0
            | S l -> sub k l)

(** val bool_dec : bool -> bool -> bool **)

let bool_dec b1 b2 =
  if b1 then if b2 then true else false else if b2 then false else true

(** val eqb : bool -> bool -> bool **)

let eqb b1 b2 =
  if b1 then b2 else if b2 then false else true

type positive =
| XI of positive
| XO of positive
| XH

type n =
| N0
| Npos of positive

type z =
| Z0
| Zpos of positive
| Zneg of positive

module Nat =
 struct
  (** val eqb : nat -> nat -> bool **)

  let rec eqb n0 m =
    match n0 with
    | O -> (match m with
            | O -> true
            | S _ -> false)
    | S n' -> (match m with
               | O -> false
               | S m' -> eqb n' m')

  (** val leb : nat -> nat -> bool **)

  let rec leb n0 m =
    match n0 with
    | O -> true
    | S n' -> (match m with
               | O -> false
               | S m' -> leb n' m')

  (** val ltb : nat -> nat -> bool **)

  let ltb n0 m =
    leb (S n0) m

  (** val max : nat -> nat -> nat **)

  let rec max n0 m =
    match n0 with
    | O -> m
    | S n' -> (match m with
               | O -> n0
               | S m' -> S (max n' m'))

  (** val eq_dec : nat -> nat -> bool **)

  let rec eq_dec n0 m =
    match n0 with
    | O -> (match m with
            | O -> true
            | S _ -> false)
    | S n1 -> (match m with
               | O -> false
               | S n2 -> eq_dec n1 n2)
 end

module Pos =
 struct
  type mask =
  | IsNul
  | IsPos of positive
  | IsNeg
 end

module Coq_Pos =
 struct
  (** val succ : positive -> positive **)

  let rec succ = function
  | XI p -> XO (succ p)
  | XO p -> XI p
  | XH -> XO XH

  (** val add : positive -> positive -> positive **)

  let rec add x y =
    match x with
    | XI p ->
      (match y with
       | XI q0 -> XO (add_carry p q0)
       | XO q0 -> XI (add p q0)
       | XH -> XO (succ p))
    | XO p ->
      (match y with
       | XI q0 -> XI (add p q0)
       | XO q0 -> XO (add p q0)
       | XH -> XI p)
    | XH -> (match y with
             | XI q0 -> XO (succ q0)
             | XO q0 -> XI q0
             | XH -> XO XH)

  (** val add_carry : positive -> positive -> positive **)

  and add_carry x y =
    match x with
    | XI p ->
      (match y with
       | XI q0 -> XI (add_carry p q0)
       | XO q0 -> XO (add_carry p q0)
       | XH -> XI (succ p))
    | XO p ->
      (match y with
       | XI q0 -> XO (add_carry p q0)
       | XO q0 -> XI (add p q0)
       | XH -> XO (succ p))
    | XH ->
      (match y with
       | XI q0 -> XI (succ q0)
       | XO q0 -> XO (succ q0)
       | XH -> XI XH)

  (** val pred_double : positive -> positive **)

  let rec pred_double = function
  | XI p -> XI (XO p)
  | XO p -> XI (pred_double p)
  | XH -> XH

  type mask = Pos.mask =
  | IsNul
  | IsPos of positive
  | IsNeg

  (** val succ_double_mask : mask -> mask **)

  let succ_double_mask = function
  | IsNul -> IsPos XH
  | IsPos p -> IsPos (XI p)
  | IsNeg -> IsNeg

  (** val double_mask : mask -> mask **)

  let double_mask = function
  | IsPos p -> IsPos (XO p)
  | x0 -> x0

  (** val double_pred_mask : positive -> mask **)

  let double_pred_mask = function
  | XI p -> IsPos (XO (XO p))
  | XO p -> IsPos (XO (pred_double p))
  | XH -> IsNul

  (** val sub_mask : positive -> positive -> mask **)

  let rec sub_mask x y =
    match x with
    | XI p ->
      (match y with
       | XI q0 -> double_mask (sub_mask p q0)
       | XO q0 -> succ_double_mask (sub_mask p q0)
       | XH -> IsPos (XO p))
    | XO p ->
      (match y with
       | XI q0 -> succ_double_mask (sub_mask_carry p q0)
       | XO q0 -> double_mask (sub_mask p q0)
       | XH -> IsPos (pred_double p))
    | XH -> (match y with
             | XH -> IsNul
             | _ -> IsNeg)

  (** val sub_mask_carry : positive -> positive -> mask **)

  and sub_mask_carry x y =
    match x with
    | XI p ->
      (match y with
       | XI q0 -> succ_double_mask (sub_mask_carry p q0)
       | XO q0 -> double_mask (sub_mask p q0)
       | XH -> IsPos (pred_double p))
    | XO p ->
      (match y with
       | XI q0 -> double_mask (sub_mask_carry p q0)
       | XO q0 -> succ_double_mask (sub_mask_carry p q0)
       | XH -> double_pred_mask p)
    | XH -> IsNeg

  (** val sub : positive -> positive -> positive **)

  let sub x y =
    match sub_mask x y with
    | IsPos z0 -> z0
    | _ -> XH

  (** val mul : positive -> positive -> positive **)

  let rec mul x y =
    match x with
    | XI p -> add y (XO (mul p y))
    | XO p -> XO (mul p y)
    | XH -> y

  (** val size_nat : positive -> nat **)

  let rec size_nat = function
  | XI p2 -> S (size_nat p2)
  | XO p2 -> S (size_nat p2)
  | XH -> S O

  (** val compare_cont : comparison -> positive -> positive -> comparison **)

  let rec compare_cont r x y =
    match x with
    | XI p ->
      (match y with
       | XI q0 -> compare_cont r p q0
       | XO q0 -> compare_cont Gt p q0
       | XH -> Gt)
    | XO p ->
      (match y with
       | XI q0 -> compare_cont Lt p q0
       | XO q0 -> compare_cont r p q0
       | XH -> Gt)
    | XH -> (match y with
             | XH -> r
             | _ -> Lt)

  (** val compare : positive -> positive -> comparison **)

  let compare =
    compare_cont Eq

  (** val eqb : positive -> positive -> bool **)

  let rec eqb p q0 =
    match p with
    | XI p2 -> (match q0 with
                | XI q1 -> eqb p2 q1
                | _ -> false)
    | XO p2 -> (match q0 with
                | XO q1 -> eqb p2 q1
                | _ -> false)
    | XH -> (match q0 with
             | XH -> true
             | _ -> false)

  (** val ggcdn :
      nat -> positive -> positive -> positive * (positive * positive) **)

  let rec ggcdn n0 a b =
    match n0 with
    | O -> (XH, (a, b))
    | S n1 ->
      (match a with
       | XI a' ->
         (match b with
          | XI b' ->
            (match compare a' b' with
             | Eq -> (a, (XH, XH))
             | Lt ->
               let (g, p) = ggcdn n1 (sub b' a') a in
               let (ba, aa) = p in (g, (aa, (add aa (XO ba))))
             | Gt ->
               let (g, p) = ggcdn n1 (sub a' b') b in
               let (ab, bb) = p in (g, ((add bb (XO ab)), bb)))
          | XO b0 ->
            let (g, p) = ggcdn n1 a b0 in
            let (aa, bb) = p in (g, (aa, (XO bb)))
          | XH -> (XH, (a, XH)))
       | XO a0 ->
         (match b with
          | XI _ ->
            let (g, p) = ggcdn n1 a0 b in
            let (aa, bb) = p in (g, ((XO aa), bb))
          | XO b0 -> let (g, p) = ggcdn n1 a0 b0 in ((XO g), p)
          | XH -> (XH, (a, XH)))
       | XH -> (XH, (XH, b)))

  (** val ggcd : positive -> positive -> positive * (positive * positive) **)

  let ggcd a b =
    ggcdn (Coq__1.add (size_nat a) (size_nat b)) a b

  (** val of_succ_nat : nat -> positive **)

  let rec of_succ_nat = function
  | O -> XH
  | S x -> succ (of_succ_nat x)

  (** val eq_dec : positive -> positive -> bool **)

  let rec eq_dec p x0 =
    match p with
    | XI p2 -> (match x0 with
                | XI p3 -> eq_dec p2 p3
                | _ -> false)
    | XO p2 -> (match x0 with
                | XO p3 -> eq_dec p2 p3
                | _ -> false)
    | XH -> (match x0 with
             | XH -> true
             | _ -> false)
 end

module N =
 struct
  (** val of_nat : nat -> n **)

  let of_nat = function
  | O -> N0
  | S n' -> Npos (Coq_Pos.of_succ_nat n')
 end

(** val hd : 'a1 -> 'a1 list -> 'a1 **)

let hd default = function
| [] -> default
| x :: _ -> x

(** val in_dec : ('a1 -> 'a1 -> bool) -> 'a1 -> 'a1 list -> bool **)

let rec in_dec h a = function
| [] -> false
| y :: l0 -> let s = h y a in if s then true else in_dec h a l0

(** val nth : nat -> 'a1 list -> 'a1 -> 'a1 **)

let rec nth n0 l default =
  match n0 with
  | O -> (match l with
          | [] -> default
          | x :: _ -> x)
  | S m -> (match l with
            | [] -> default
            | _ :: t0 -> nth m t0 default)

(** val nth_error : 'a1 list -> nat -> 'a1 option **)

let rec nth_error l = function
| O -> (match l with
        | [] -> None
        | x :: _ -> Some x)
| S n1 -> (match l with
           | [] -> None
           | _ :: l0 -> nth_error l0 n1)

(** val last : 'a1 list -> 'a1 -> 'a1 **)

let rec last l d =
  match l with
  | [] -> d
  | a :: l0 -> (match l0 with
                | [] -> a
                | _ :: _ -> last l0 d)

(** val map : ('a1 -> 'a2) -> 'a1 list -> 'a2 list **)

let rec map f = function
| [] -> []
| a :: t0 -> (f a) :: (map f t0)

(** val flat_map : ('a1 -> 'a2 list) -> 'a1 list -> 'a2 list **)

let rec flat_map f = function
| [] -> []
| x :: t0 -> app (f x) (flat_map f t0)

(** val fold_left : ('a1 -> 'a2 -> 'a1) -> 'a2 list -> 'a1 -> 'a1 **)

let rec fold_left f l a0 =
  match l with
  | [] -> a0
  | b :: t0 -> fold_left f t0 (f a0 b)

(** val existsb : ('a1 -> bool) -> 'a1 list -> bool **)

let rec existsb f = function
| [] -> false
| a :: l0 -> (||) (f a) (existsb f l0)

(** val forallb : ('a1 -> bool) -> 'a1 list -> bool **)

let rec forallb f = function
| [] -> true
| a :: l0 -> (&&) (f a) (forallb f l0)

(** val filter : ('a1 -> bool) -> 'a1 list -> 'a1 list **)

let rec filter f = function
| [] -> []
| x :: l0 -> if f x then x :: (filter f l0) else filter f l0

(** val find : ('a1 -> bool) -> 'a1 list -> 'a1 option **)

let rec find f = function
| [] -> None
| x :: tl -> if f x then Some x else find f tl

(** val seq : nat -> nat -> nat list **)

let rec seq start = function
| O -> []
| S len0 -> start :: (seq (S start) len0)

module Z =
 struct
  (** val double : z -> z **)

  let double = function
  | Z0 -> Z0
  | Zpos p -> Zpos (XO p)
  | Zneg p -> Zneg (XO p)

  (** val succ_double : z -> z **)

  let succ_double = function
  | Z0 -> Zpos XH
  | Zpos p -> Zpos (XI p)
  | Zneg p -> Zneg (Coq_Pos.pred_double p)

  (** val pred_double : z -> z **)

  let pred_double = function
  | Z0 -> Zneg XH
  | Zpos p -> Zpos (Coq_Pos.pred_double p)
  | Zneg p -> Zneg (XI p)

  (** val pos_sub : positive -> positive -> z **)

  let rec pos_sub x y =
    match x with
    | XI p ->
      (match y with
       | XI q0 -> double (pos_sub p q0)
       | XO q0 -> succ_double (pos_sub p q0)
       | XH -> Zpos (XO p))
    | XO p ->
      (match y with
       | XI q0 -> pred_double (pos_sub p q0)
       | XO q0 -> double (pos_sub p q0)
       | XH -> Zpos (Coq_Pos.pred_double p))
    | XH ->
      (match y with
       | XI q0 -> Zneg (XO q0)
       | XO q0 -> Zneg (Coq_Pos.pred_double q0)
       | XH -> Z0)

  (** val add : z -> z -> z **)

  let add x y =
    match x with
    | Z0 -> y
    | Zpos x' ->
      (match y with
       | Z0 -> x
       | Zpos y' -> Zpos (Coq_Pos.add x' y')
       | Zneg y' -> pos_sub x' y')
    | Zneg x' ->
      (match y with
       | Z0 -> x
       | Zpos y' -> pos_sub y' x'
       | Zneg y' -> Zneg (Coq_Pos.add x' y'))

  (** val opp : z -> z **)

  let opp = function
  | Z0 -> Z0
  | Zpos x0 -> Zneg x0
  | Zneg x0 -> Zpos x0

  (** val mul : z -> z -> z **)

  let mul x y =
    match x with
    | Z0 -> Z0
    | Zpos x' ->
      (match y with
       | Z0 -> Z0
       | Zpos y' -> Zpos (Coq_Pos.mul x' y')
       | Zneg y' -> Zneg (Coq_Pos.mul x' y'))
    | Zneg x' ->
      (match y with
       | Z0 -> Z0
       | Zpos y' -> Zneg (Coq_Pos.mul x' y')
       | Zneg y' -> Zpos (Coq_Pos.mul x' y'))

  (** val compare : z -> z -> comparison **)

  let compare x y =
    match x with
    | Z0 -> (match y with
             | Z0 -> Eq
             | Zpos _ -> Lt
             | Zneg _ -> Gt)
    | Zpos x' -> (match y with
                  | Zpos y' -> Coq_Pos.compare x' y'
                  | _ -> Gt)
    | Zneg x' ->
      (match y with
       | Zneg y' -> compOpp (Coq_Pos.compare x' y')
       | _ -> Lt)

  (** val sgn : z -> z **)

  let sgn = function
  | Z0 -> Z0
  | Zpos _ -> Zpos XH
  | Zneg _ -> Zneg XH

  (** val leb : z -> z -> bool **)

  let leb x y =
    match compare x y with
    | Gt -> false
    | _ -> true

  (** val ltb : z -> z -> bool **)

  let ltb x y =
    match compare x y with
    | Lt -> true
    | _ -> false

  (** val max : z -> z -> z **)

  let max n0 m =
    match compare n0 m with
    | Lt -> m
    | _ -> n0

  (** val abs : z -> z **)

  let abs = function
  | Zneg p -> Zpos p
  | x -> x

  (** val of_nat : nat -> z **)

  let of_nat = function
  | O -> Z0
  | S n1 -> Zpos (Coq_Pos.of_succ_nat n1)

  (** val to_pos : z -> positive **)

  let to_pos = function
  | Zpos p -> p
  | _ -> XH

  (** val ggcd : z -> z -> z * (z * z) **)

  let ggcd a b =
    match a with
    | Z0 -> ((abs b), (Z0, (sgn b)))
    | Zpos a0 ->
      (match b with
       | Z0 -> ((abs a), ((sgn a), Z0))
       | Zpos b0 ->
         let (g, p) = Coq_Pos.ggcd a0 b0 in
         let (aa, bb) = p in ((Zpos g), ((Zpos aa), (Zpos bb)))
       | Zneg b0 ->
         let (g, p) = Coq_Pos.ggcd a0 b0 in
         let (aa, bb) = p in ((Zpos g), ((Zpos aa), (Zneg bb))))
    | Zneg a0 ->
      (match b with
       | Z0 -> ((abs a), ((sgn a), Z0))
       | Zpos b0 ->
         let (g, p) = Coq_Pos.ggcd a0 b0 in
         let (aa, bb) = p in ((Zpos g), ((Zneg aa), (Zpos bb)))
       | Zneg b0 ->
         let (g, p) = Coq_Pos.ggcd a0 b0 in
         let (aa, bb) = p in ((Zpos g), ((Zneg aa), (Zneg bb))))

  (** val eq_dec : z -> z -> bool **)

  let eq_dec x y =
    match x with
    | Z0 -> (match y with
             | Z0 -> true
             | _ -> false)
    | Zpos p -> (match y with
                 | Zpos p2 -> Coq_Pos.eq_dec p p2
                 | _ -> false)
    | Zneg p -> (match y with
                 | Zneg p2 -> Coq_Pos.eq_dec p p2
                 | _ -> false)
 end

(** val zeq_bool : z -> z -> bool **)

let zeq_bool x y =
  match Z.compare x y with
  | Eq -> true
  | _ -> false

(** val string_dec : char list -> char list -> bool **)

let rec string_dec s x =
  match s with
  | [] -> (match x with
           | [] -> true
           | _::_ -> false)
  | a::s0 ->
    (match x with
     | [] -> false
     | a0::s1 -> if (=) a a0 then string_dec s0 s1 else false)

(** val eqb0 : char list -> char list -> bool **)

let rec eqb0 s1 s2 =
  match s1 with
  | [] -> (match s2 with
           | [] -> true
           | _::_ -> false)
  | c1::s1' ->
    (match s2 with
     | [] -> false
     | c2::s2' -> if (=) c1 c2 then eqb0 s1' s2' else false)

type 'c pExpr =
| PEc of 'c
| PEX of positive
| PEadd of 'c pExpr * 'c pExpr
| PEsub of 'c pExpr * 'c pExpr
| PEmul of 'c pExpr * 'c pExpr
| PEopp of 'c pExpr
| PEpow of 'c pExpr * n

type 'c pol =
| Pc of 'c
| Pinj of positive * 'c pol
| PX of 'c pol * positive * 'c pol

(** val p0 : 'a1 -> 'a1 pol **)

let p0 cO =
  Pc cO

(** val p1 : 'a1 -> 'a1 pol **)

let p1 cI =
  Pc cI

(** val peq : ('a1 -> 'a1 -> bool) -> 'a1 pol -> 'a1 pol -> bool **)

let rec peq ceqb p p' =
  match p with
  | Pc c -> (match p' with
             | Pc c' -> ceqb c c'
             | _ -> false)
  | Pinj (j, q0) ->
    (match p' with
     | Pinj (j', q') ->
       (match Coq_Pos.compare j j' with
        | Eq -> peq ceqb q0 q'
        | _ -> false)
     | _ -> false)
  | PX (p2, i, q0) ->
    (match p' with
     | PX (p'0, i', q') ->
       (match Coq_Pos.compare i i' with
        | Eq -> if peq ceqb p2 p'0 then peq ceqb q0 q' else false
        | _ -> false)
     | _ -> false)

(** val mkPinj : positive -> 'a1 pol -> 'a1 pol **)

let mkPinj j p = match p with
| Pc _ -> p
| Pinj (j', q0) -> Pinj ((Coq_Pos.add j j'), q0)
| PX (_, _, _) -> Pinj (j, p)

(** val mkPinj_pred : positive -> 'a1 pol -> 'a1 pol **)

let mkPinj_pred j p =
  match j with
  | XI j0 -> Pinj ((XO j0), p)
  | XO j0 -> Pinj ((Coq_Pos.pred_double j0), p)
  | XH -> p

(** val mkPX :
    'a1 -> ('a1 -> 'a1 -> bool) -> 'a1 pol -> positive -> 'a1 pol -> 'a1 pol **)

let mkPX cO ceqb p i q0 =
  match p with
  | Pc c -> if ceqb c cO then mkPinj XH q0 else PX (p, i, q0)
  | Pinj (_, _) -> PX (p, i, q0)
  | PX (p', i', q') ->
    if peq ceqb q' (p0 cO)
    then PX (p', (Coq_Pos.add i' i), q0)
    else PX (p, i, q0)

(** val mkXi : 'a1 -> 'a1 -> positive -> 'a1 pol **)

let mkXi cO cI i =
  PX ((p1 cI), i, (p0 cO))

(** val mkX : 'a1 -> 'a1 -> 'a1 pol **)

let mkX cO cI =
  mkXi cO cI XH

(** val popp : ('a1 -> 'a1) -> 'a1 pol -> 'a1 pol **)

let rec popp copp = function
| Pc c -> Pc (copp c)
| Pinj (j, q0) -> Pinj (j, (popp copp q0))
| PX (p2, i, q0) -> PX ((popp copp p2), i, (popp copp q0))

(** val paddC : ('a1 -> 'a1 -> 'a1) -> 'a1 pol -> 'a1 -> 'a1 pol **)

let rec paddC cadd p c =
  match p with
  | Pc c1 -> Pc (cadd c1 c)
  | Pinj (j, q0) -> Pinj (j, (paddC cadd q0 c))
  | PX (p2, i, q0) -> PX (p2, i, (paddC cadd q0 c))

(** val psubC : ('a1 -> 'a1 -> 'a1) -> 'a1 pol -> 'a1 -> 'a1 pol **)

let rec psubC csub p c =
  match p with
  | Pc c1 -> Pc (csub c1 c)
  | Pinj (j, q0) -> Pinj (j, (psubC csub q0 c))
  | PX (p2, i, q0) -> PX (p2, i, (psubC csub q0 c))

(** val paddI :
    ('a1 -> 'a1 -> 'a1) -> ('a1 pol -> 'a1 pol -> 'a1 pol) -> 'a1 pol ->
    positive -> 'a1 pol -> 'a1 pol **)

let rec paddI cadd pop q0 j = function
| Pc c -> mkPinj j (paddC cadd q0 c)
| Pinj (j', q') ->
  (match Z.pos_sub j' j with
   | Z0 -> mkPinj j (pop q' q0)
   | Zpos k -> mkPinj j (pop (Pinj (k, q')) q0)
   | Zneg k -> mkPinj j' (paddI cadd pop q0 k q'))
| PX (p2, i, q') ->
  (match j with
   | XI j0 -> PX (p2, i, (paddI cadd pop q0 (XO j0) q'))
   | XO j0 -> PX (p2, i, (paddI cadd pop q0 (Coq_Pos.pred_double j0) q'))
   | XH -> PX (p2, i, (pop q' q0)))

(** val psubI :
    ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1) -> ('a1 pol -> 'a1 pol -> 'a1 pol) ->
    'a1 pol -> positive -> 'a1 pol -> 'a1 pol **)

let rec psubI cadd copp pop q0 j = function
| Pc c -> mkPinj j (paddC cadd (popp copp q0) c)
| Pinj (j', q') ->
  (match Z.pos_sub j' j with
   | Z0 -> mkPinj j (pop q' q0)
   | Zpos k -> mkPinj j (pop (Pinj (k, q')) q0)
   | Zneg k -> mkPinj j' (psubI cadd copp pop q0 k q'))
| PX (p2, i, q') ->
  (match j with
   | XI j0 -> PX (p2, i, (psubI cadd copp pop q0 (XO j0) q'))
   | XO j0 -> PX (p2, i, (psubI cadd copp pop q0 (Coq_Pos.pred_double j0) q'))
   | XH -> PX (p2, i, (pop q' q0)))

(** val paddX :
    'a1 -> ('a1 -> 'a1 -> bool) -> ('a1 pol -> 'a1 pol -> 'a1 pol) -> 'a1 pol
    -> positive -> 'a1 pol -> 'a1 pol **)

let rec paddX cO ceqb pop p' i' p = match p with
| Pc _ -> PX (p', i', p)
| Pinj (j, q') ->
  (match j with
   | XI j0 -> PX (p', i', (Pinj ((XO j0), q')))
   | XO j0 -> PX (p', i', (Pinj ((Coq_Pos.pred_double j0), q')))
   | XH -> PX (p', i', q'))
| PX (p2, i, q') ->
  (match Z.pos_sub i i' with
   | Z0 -> mkPX cO ceqb (pop p2 p') i q'
   | Zpos k -> mkPX cO ceqb (pop (PX (p2, k, (p0 cO))) p') i' q'
   | Zneg k -> mkPX cO ceqb (paddX cO ceqb pop p' k p2) i q')

(** val psubX :
    'a1 -> ('a1 -> 'a1) -> ('a1 -> 'a1 -> bool) -> ('a1 pol -> 'a1 pol -> 'a1
    pol) -> 'a1 pol -> positive -> 'a1 pol -> 'a1 pol **)

let rec psubX cO copp ceqb pop p' i' p = match p with
| Pc _ -> PX ((popp copp p'), i', p)
| Pinj (j, q') ->
  (match j with
   | XI j0 -> PX ((popp copp p'), i', (Pinj ((XO j0), q')))
   | XO j0 -> PX ((popp copp p'), i', (Pinj ((Coq_Pos.pred_double j0), q')))
   | XH -> PX ((popp copp p'), i', q'))
| PX (p2, i, q') ->
  (match Z.pos_sub i i' with
   | Z0 -> mkPX cO ceqb (pop p2 p') i q'
   | Zpos k -> mkPX cO ceqb (pop (PX (p2, k, (p0 cO))) p') i' q'
   | Zneg k -> mkPX cO ceqb (psubX cO copp ceqb pop p' k p2) i q')

(** val padd :
    'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> bool) -> 'a1 pol -> 'a1 pol
    -> 'a1 pol **)

let rec padd cO cadd ceqb p = function
| Pc c' -> paddC cadd p c'
| Pinj (j', q') -> paddI cadd (padd cO cadd ceqb) q' j' p
| PX (p'0, i', q') ->
  (match p with
   | Pc c -> PX (p'0, i', (paddC cadd q' c))
   | Pinj (j, q0) ->
     (match j with
      | XI j0 -> PX (p'0, i', (padd cO cadd ceqb (Pinj ((XO j0), q0)) q'))
      | XO j0 ->
        PX (p'0, i',
          (padd cO cadd ceqb (Pinj ((Coq_Pos.pred_double j0), q0)) q'))
      | XH -> PX (p'0, i', (padd cO cadd ceqb q0 q')))
   | PX (p2, i, q0) ->
     (match Z.pos_sub i i' with
      | Z0 ->
        mkPX cO ceqb (padd cO cadd ceqb p2 p'0) i (padd cO cadd ceqb q0 q')
      | Zpos k ->
        mkPX cO ceqb (padd cO cadd ceqb (PX (p2, k, (p0 cO))) p'0) i'
          (padd cO cadd ceqb q0 q')
      | Zneg k ->
        mkPX cO ceqb (paddX cO ceqb (padd cO cadd ceqb) p'0 k p2) i
          (padd cO cadd ceqb q0 q')))

(** val psub :
    'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1) -> ('a1
    -> 'a1 -> bool) -> 'a1 pol -> 'a1 pol -> 'a1 pol **)

let rec psub cO cadd csub copp ceqb p = function
| Pc c' -> psubC csub p c'
| Pinj (j', q') -> psubI cadd copp (psub cO cadd csub copp ceqb) q' j' p
| PX (p'0, i', q') ->
  (match p with
   | Pc c -> PX ((popp copp p'0), i', (paddC cadd (popp copp q') c))
   | Pinj (j, q0) ->
     (match j with
      | XI j0 ->
        PX ((popp copp p'0), i',
          (psub cO cadd csub copp ceqb (Pinj ((XO j0), q0)) q'))
      | XO j0 ->
        PX ((popp copp p'0), i',
          (psub cO cadd csub copp ceqb (Pinj ((Coq_Pos.pred_double j0), q0))
            q'))
      | XH -> PX ((popp copp p'0), i', (psub cO cadd csub copp ceqb q0 q')))
   | PX (p2, i, q0) ->
     (match Z.pos_sub i i' with
      | Z0 ->
        mkPX cO ceqb (psub cO cadd csub copp ceqb p2 p'0) i
          (psub cO cadd csub copp ceqb q0 q')
      | Zpos k ->
        mkPX cO ceqb (psub cO cadd csub copp ceqb (PX (p2, k, (p0 cO))) p'0)
          i' (psub cO cadd csub copp ceqb q0 q')
      | Zneg k ->
        mkPX cO ceqb
          (psubX cO copp ceqb (psub cO cadd csub copp ceqb) p'0 k p2) i
          (psub cO cadd csub copp ceqb q0 q')))

(** val pmulC_aux :
    'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> bool) -> 'a1 pol -> 'a1 ->
    'a1 pol **)

let rec pmulC_aux cO cmul ceqb p c =
  match p with
  | Pc c' -> Pc (cmul c' c)
  | Pinj (j, q0) -> mkPinj j (pmulC_aux cO cmul ceqb q0 c)
  | PX (p2, i, q0) ->
    mkPX cO ceqb (pmulC_aux cO cmul ceqb p2 c) i (pmulC_aux cO cmul ceqb q0 c)

(** val pmulC :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> bool) -> 'a1 pol ->
    'a1 -> 'a1 pol **)

let pmulC cO cI cmul ceqb p c =
  if ceqb c cO
  then p0 cO
  else if ceqb c cI then p else pmulC_aux cO cmul ceqb p c

(** val pmulI :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> bool) -> ('a1 pol ->
    'a1 pol -> 'a1 pol) -> 'a1 pol -> positive -> 'a1 pol -> 'a1 pol **)

let rec pmulI cO cI cmul ceqb pmul1 q0 j = function
| Pc c -> mkPinj j (pmulC cO cI cmul ceqb q0 c)
| Pinj (j', q') ->
  (match Z.pos_sub j' j with
   | Z0 -> mkPinj j (pmul1 q' q0)
   | Zpos k -> mkPinj j (pmul1 (Pinj (k, q')) q0)
   | Zneg k -> mkPinj j' (pmulI cO cI cmul ceqb pmul1 q0 k q'))
| PX (p', i', q') ->
  (match j with
   | XI j' ->
     mkPX cO ceqb (pmulI cO cI cmul ceqb pmul1 q0 j p') i'
       (pmulI cO cI cmul ceqb pmul1 q0 (XO j') q')
   | XO j' ->
     mkPX cO ceqb (pmulI cO cI cmul ceqb pmul1 q0 j p') i'
       (pmulI cO cI cmul ceqb pmul1 q0 (Coq_Pos.pred_double j') q')
   | XH ->
     mkPX cO ceqb (pmulI cO cI cmul ceqb pmul1 q0 XH p') i' (pmul1 q' q0))

(** val pmul :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1
    -> bool) -> 'a1 pol -> 'a1 pol -> 'a1 pol **)

let rec pmul cO cI cadd cmul ceqb p p'' = match p'' with
| Pc c -> pmulC cO cI cmul ceqb p c
| Pinj (j', q') -> pmulI cO cI cmul ceqb (pmul cO cI cadd cmul ceqb) q' j' p
| PX (p', i', q') ->
  (match p with
   | Pc c -> pmulC cO cI cmul ceqb p'' c
   | Pinj (j, q0) ->
     let qQ' =
       match j with
       | XI j0 -> pmul cO cI cadd cmul ceqb (Pinj ((XO j0), q0)) q'
       | XO j0 ->
         pmul cO cI cadd cmul ceqb (Pinj ((Coq_Pos.pred_double j0), q0)) q'
       | XH -> pmul cO cI cadd cmul ceqb q0 q'
     in
     mkPX cO ceqb (pmul cO cI cadd cmul ceqb p p') i' qQ'
   | PX (p2, i, q0) ->
     let qQ' = pmul cO cI cadd cmul ceqb q0 q' in
     let pQ' = pmulI cO cI cmul ceqb (pmul cO cI cadd cmul ceqb) q' XH p2 in
     let qP' = pmul cO cI cadd cmul ceqb (mkPinj XH q0) p' in
     let pP' = pmul cO cI cadd cmul ceqb p2 p' in
     padd cO cadd ceqb
       (mkPX cO ceqb (padd cO cadd ceqb (mkPX cO ceqb pP' i (p0 cO)) qP') i'
         (p0 cO)) (mkPX cO ceqb pQ' i qQ'))

(** val psquare :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1
    -> bool) -> 'a1 pol -> 'a1 pol **)

let rec psquare cO cI cadd cmul ceqb = function
| Pc c -> Pc (cmul c c)
| Pinj (j, q0) -> Pinj (j, (psquare cO cI cadd cmul ceqb q0))
| PX (p2, i, q0) ->
  let twoPQ =
    pmul cO cI cadd cmul ceqb p2
      (mkPinj XH (pmulC cO cI cmul ceqb q0 (cadd cI cI)))
  in
  let q2 = psquare cO cI cadd cmul ceqb q0 in
  let p3 = psquare cO cI cadd cmul ceqb p2 in
  mkPX cO ceqb (padd cO cadd ceqb (mkPX cO ceqb p3 i (p0 cO)) twoPQ) i q2

(** val mk_X : 'a1 -> 'a1 -> positive -> 'a1 pol **)

let mk_X cO cI j =
  mkPinj_pred j (mkX cO cI)

(** val ppow_pos :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1
    -> bool) -> ('a1 pol -> 'a1 pol) -> 'a1 pol -> 'a1 pol -> positive -> 'a1
    pol **)

let rec ppow_pos cO cI cadd cmul ceqb subst_l res p = function
| XI p3 ->
  subst_l
    (pmul cO cI cadd cmul ceqb
      (ppow_pos cO cI cadd cmul ceqb subst_l
        (ppow_pos cO cI cadd cmul ceqb subst_l res p p3) p p3) p)
| XO p3 ->
  ppow_pos cO cI cadd cmul ceqb subst_l
    (ppow_pos cO cI cadd cmul ceqb subst_l res p p3) p p3
| XH -> subst_l (pmul cO cI cadd cmul ceqb res p)

(** val ppow_N :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1
    -> bool) -> ('a1 pol -> 'a1 pol) -> 'a1 pol -> n -> 'a1 pol **)

let ppow_N cO cI cadd cmul ceqb subst_l p = function
| N0 -> p1 cI
| Npos p2 -> ppow_pos cO cI cadd cmul ceqb subst_l (p1 cI) p p2

(** val norm_aux :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1
    -> 'a1) -> ('a1 -> 'a1) -> ('a1 -> 'a1 -> bool) -> 'a1 pExpr -> 'a1 pol **)

let rec norm_aux cO cI cadd cmul csub copp ceqb = function
| PEc c -> Pc c
| PEX j -> mk_X cO cI j
| PEadd (pe1, pe2) ->
  (match pe1 with
   | PEopp pe3 ->
     psub cO cadd csub copp ceqb
       (norm_aux cO cI cadd cmul csub copp ceqb pe2)
       (norm_aux cO cI cadd cmul csub copp ceqb pe3)
   | _ ->
     (match pe2 with
      | PEopp pe3 ->
        psub cO cadd csub copp ceqb
          (norm_aux cO cI cadd cmul csub copp ceqb pe1)
          (norm_aux cO cI cadd cmul csub copp ceqb pe3)
      | _ ->
        padd cO cadd ceqb (norm_aux cO cI cadd cmul csub copp ceqb pe1)
          (norm_aux cO cI cadd cmul csub copp ceqb pe2)))
| PEsub (pe1, pe2) ->
  psub cO cadd csub copp ceqb (norm_aux cO cI cadd cmul csub copp ceqb pe1)
    (norm_aux cO cI cadd cmul csub copp ceqb pe2)
| PEmul (pe1, pe2) ->
  pmul cO cI cadd cmul ceqb (norm_aux cO cI cadd cmul csub copp ceqb pe1)
    (norm_aux cO cI cadd cmul csub copp ceqb pe2)
| PEopp pe1 -> popp copp (norm_aux cO cI cadd cmul csub copp ceqb pe1)
| PEpow (pe1, n0) ->
  ppow_N cO cI cadd cmul ceqb (fun p -> p)
    (norm_aux cO cI cadd cmul csub copp ceqb pe1) n0

(** val cneqb : ('a1 -> 'a1 -> bool) -> 'a1 -> 'a1 -> bool **)

let cneqb ceqb x y =
  negb (ceqb x y)

(** val cltb :
    ('a1 -> 'a1 -> bool) -> ('a1 -> 'a1 -> bool) -> 'a1 -> 'a1 -> bool **)

let cltb ceqb cleb x y =
  (&&) (cleb x y) (cneqb ceqb x y)

type 'c polC = 'c pol

type op1 =
| Equal
| NonEqual
| Strict
| NonStrict

type 'c nFormula = 'c polC * op1

(** val opMult : op1 -> op1 -> op1 option **)

let opMult o o' =
  match o with
  | Equal -> Some Equal
  | NonEqual ->
    (match o' with
     | Equal -> Some Equal
     | NonEqual -> Some NonEqual
     | _ -> None)
  | Strict -> (match o' with
               | NonEqual -> None
               | _ -> Some o')
  | NonStrict ->
    (match o' with
     | Equal -> Some Equal
     | NonEqual -> None
     | _ -> Some NonStrict)

(** val opAdd : op1 -> op1 -> op1 option **)

let opAdd o o' =
  match o with
  | Equal -> Some o'
  | NonEqual -> (match o' with
                 | Equal -> Some NonEqual
                 | _ -> None)
  | Strict -> (match o' with
               | NonEqual -> None
               | _ -> Some Strict)
  | NonStrict ->
    (match o' with
     | Equal -> Some NonStrict
     | NonEqual -> None
     | x -> Some x)

type 'c psatz =
| PsatzLet of 'c psatz * 'c psatz
| PsatzIn of nat
| PsatzSquare of 'c polC
| PsatzMulC of 'c polC * 'c psatz
| PsatzMulE of 'c psatz * 'c psatz
| PsatzAdd of 'c psatz * 'c psatz
| PsatzC of 'c
| PsatzZ

(** val map_option : ('a1 -> 'a2 option) -> 'a1 option -> 'a2 option **)

let map_option f = function
| Some x -> f x
| None -> None

(** val map_option2 :
    ('a1 -> 'a2 -> 'a3 option) -> 'a1 option -> 'a2 option -> 'a3 option **)

let map_option2 f o o' =
  match o with
  | Some x -> (match o' with
               | Some x' -> f x x'
               | None -> None)
  | None -> None

(** val pexpr_times_nformula :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1
    -> bool) -> 'a1 polC -> 'a1 nFormula -> 'a1 nFormula option **)

let pexpr_times_nformula cO cI cplus ctimes ceqb e = function
| (ef, o) ->
  (match o with
   | Equal -> Some ((pmul cO cI cplus ctimes ceqb e ef), Equal)
   | _ -> None)

(** val nformula_times_nformula :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1
    -> bool) -> 'a1 nFormula -> 'a1 nFormula -> 'a1 nFormula option **)

let nformula_times_nformula cO cI cplus ctimes ceqb f1 f2 =
  let (e1, o1) = f1 in
  let (e2, o2) = f2 in
  map_option (fun x -> Some ((pmul cO cI cplus ctimes ceqb e1 e2), x))
    (opMult o1 o2)

(** val nformula_plus_nformula :
    'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> bool) -> 'a1 nFormula -> 'a1
    nFormula -> 'a1 nFormula option **)

let nformula_plus_nformula cO cplus ceqb f1 f2 =
  let (e1, o1) = f1 in
  let (e2, o2) = f2 in
  map_option (fun x -> Some ((padd cO cplus ceqb e1 e2), x)) (opAdd o1 o2)

(** val eval_Psatz :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1
    -> bool) -> ('a1 -> 'a1 -> bool) -> 'a1 nFormula list -> 'a1 psatz -> 'a1
    nFormula option **)

let rec eval_Psatz cO cI cplus ctimes ceqb cleb l = function
| PsatzLet (p2, p3) ->
  (match eval_Psatz cO cI cplus ctimes ceqb cleb l p2 with
   | Some f -> eval_Psatz cO cI cplus ctimes ceqb cleb (f :: l) p3
   | None -> None)
| PsatzIn n0 -> Some (nth n0 l ((Pc cO), Equal))
| PsatzSquare e0 -> Some ((psquare cO cI cplus ctimes ceqb e0), NonStrict)
| PsatzMulC (re, e0) ->
  map_option (pexpr_times_nformula cO cI cplus ctimes ceqb re)
    (eval_Psatz cO cI cplus ctimes ceqb cleb l e0)
| PsatzMulE (f1, f2) ->
  map_option2 (nformula_times_nformula cO cI cplus ctimes ceqb)
    (eval_Psatz cO cI cplus ctimes ceqb cleb l f1)
    (eval_Psatz cO cI cplus ctimes ceqb cleb l f2)
| PsatzAdd (f1, f2) ->
  map_option2 (nformula_plus_nformula cO cplus ceqb)
    (eval_Psatz cO cI cplus ctimes ceqb cleb l f1)
    (eval_Psatz cO cI cplus ctimes ceqb cleb l f2)
| PsatzC c -> if cltb ceqb cleb cO c then Some ((Pc c), Strict) else None
| PsatzZ -> Some ((Pc cO), Equal)

(** val check_inconsistent :
    'a1 -> ('a1 -> 'a1 -> bool) -> ('a1 -> 'a1 -> bool) -> 'a1 nFormula ->
    bool **)

let check_inconsistent cO ceqb cleb = function
| (e, op) ->
  (match e with
   | Pc c ->
     (match op with
      | Equal -> cneqb ceqb c cO
      | NonEqual -> ceqb c cO
      | Strict -> cleb c cO
      | NonStrict -> cltb ceqb cleb c cO)
   | _ -> false)

(** val check_normalised_formulas :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1
    -> bool) -> ('a1 -> 'a1 -> bool) -> 'a1 nFormula list -> 'a1 psatz -> bool **)

let check_normalised_formulas cO cI cplus ctimes ceqb cleb l cm =
  match eval_Psatz cO cI cplus ctimes ceqb cleb l cm with
  | Some f -> check_inconsistent cO ceqb cleb f
  | None -> false

(** val norm :
    'a1 -> 'a1 -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1 -> 'a1) -> ('a1 -> 'a1
    -> 'a1) -> ('a1 -> 'a1) -> ('a1 -> 'a1 -> bool) -> 'a1 pExpr -> 'a1 pol **)

let norm =
  norm_aux

type q = { qnum : z; qden : positive }

(** val inject_Z : z -> q **)

let inject_Z x =
  { qnum = x; qden = XH }

(** val qeq_bool : q -> q -> bool **)

let qeq_bool x y =
  zeq_bool (Z.mul x.qnum (Zpos y.qden)) (Z.mul y.qnum (Zpos x.qden))

(** val qle_bool : q -> q -> bool **)

let qle_bool x y =
  Z.leb (Z.mul x.qnum (Zpos y.qden)) (Z.mul y.qnum (Zpos x.qden))

(** val qplus : q -> q -> q **)

let qplus x y =
  { qnum = (Z.add (Z.mul x.qnum (Zpos y.qden)) (Z.mul y.qnum (Zpos x.qden)));
    qden = (Coq_Pos.mul x.qden y.qden) }

(** val qmult : q -> q -> q **)

let qmult x y =
  { qnum = (Z.mul x.qnum y.qnum); qden = (Coq_Pos.mul x.qden y.qden) }

(** val qopp : q -> q **)

let qopp x =
  { qnum = (Z.opp x.qnum); qden = x.qden }

(** val qminus : q -> q -> q **)

let qminus x y =
  qplus x (qopp y)

(** val qinv : q -> q **)

let qinv x =
  match x.qnum with
  | Z0 -> { qnum = Z0; qden = XH }
  | Zpos p -> { qnum = (Zpos x.qden); qden = p }
  | Zneg p -> { qnum = (Zneg x.qden); qden = p }

(** val qdiv : q -> q -> q **)

let qdiv x y =
  qmult x (qinv y)

(** val qred : q -> q **)

let qred q0 =
  let { qnum = q1; qden = q2 } = q0 in
  let (r1, r2) = snd (Z.ggcd q1 (Zpos q2)) in
  { qnum = r1; qden = (Z.to_pos r2) }

type vehicle = char list

type signal =
| Place_lon
| Place_lat
| Speed_lon
| Speed_lat
| Acceleration_lon
| Acceleration_lat
| Jerk_lon
| Own of char list

type size =
| Length
| Width
| Kind

type term =
| Num of q
| Par of char list
| Var of char list
| Sig of signal * vehicle
| Siz of size * vehicle
| Add of term * term
| Mul of term * term
| Pow of term * nat
| Div of term * term
| Max of term * term
| Min of term * term

type side =
| Fin of term
| Inv of term

type comparison0 =
| LT
| LE
| GT
| GE

type road =
| Free of char list
| Bound of nat

type zone =
| Main
| Merge
| Depart

type domain =
| Lanes
| Adjacent of road
| Lanelets of road
| Zone of zone

type formula =
| Truth of bool
| Compare of side * comparison0 * side
| Occupies of vehicle * road
| Some_ of nat * domain * formula
| Every of nat * domain * formula
| Not of formula
| And of formula * formula
| Or of formula * formula
| Until of formula * term * term option * formula
| Eventually of term * term option * formula
| Always of term * term option * formula

type element = __

type bound =
| At_least_0 of char list
| Above_0 of char list
| Own_at_least of char list * vehicle * q
| Own_at_most of char list * vehicle * q

type vec = q list

(** val vadd : vec -> vec -> vec **)

let rec vadd u v =
  match u with
  | [] -> v
  | p :: u0 ->
    (match v with
     | [] -> u
     | q0 :: v0 -> (qred (qplus p q0)) :: (vadd u0 v0))

(** val vscale : q -> vec -> vec **)

let vscale k v =
  map (fun q0 -> qred (qmult k q0)) v

(** val vsub : vec -> vec -> vec **)

let vsub u v =
  vadd u (vscale { qnum = (Zneg XH); qden = XH } v)

(** val unit1 : nat -> vec **)

let rec unit1 = function
| O -> { qnum = (Zpos XH); qden = XH } :: []
| S n1 -> { qnum = Z0; qden = XH } :: (unit1 n1)

type con = bool * vec

(** val get : nat -> 'a1 list -> 'a1 option **)

let get i l =
  if Nat.ltb i (length l) then nth_error l (sub (length l) (S i)) else None

type wit = (nat * q) list

(** val combine_cons : con list -> wit -> con option **)

let rec combine_cons c = function
| [] -> Some (false, [])
| p :: w0 ->
  let (i, q0) = p in
  (match get i c with
   | Some c0 ->
     let (s, v) = c0 in
     (match combine_cons c w0 with
      | Some c1 ->
        let (s', u) = c1 in
        if qle_bool { qnum = Z0; qden = XH } q0
        then Some
               (((||) ((&&) s (negb (qeq_bool q0 { qnum = Z0; qden = XH })))
                  s'), (vadd (vscale q0 v) u))
        else None
      | None -> None)
   | None -> None)

(** val zero : vec -> bool **)

let zero v =
  forallb (fun q0 -> qeq_bool q0 { qnum = Z0; qden = XH }) v

(** val absurd_con : con -> bool **)

let absurd_con c =
  match snd c with
  | [] -> fst c
  | k :: v ->
    (&&) (zero v)
      (if fst c
       then qle_bool k { qnum = Z0; qden = XH }
       else negb (qle_bool { qnum = Z0; qden = XH } k))

(** val farkas : con list -> wit -> bool **)

let farkas c w =
  match combine_cons c w with
  | Some c0 -> absurd_con c0
  | None -> false

(** val entails : (bool * vec) list -> vec -> wit -> bool **)

let entails c v w =
  farkas ((true, (vscale { qnum = (Zneg XH); qden = XH } v)) :: c) w

(** val entails_lt : (bool * vec) list -> vec -> wit -> bool **)

let entails_lt c v w =
  farkas ((false, (vscale { qnum = (Zneg XH); qden = XH } v)) :: c) w

(** val q_dec : q -> q -> bool **)

let q_dec p q0 =
  let { qnum = qnum0; qden = qden0 } = p in
  let { qnum = qnum1; qden = qden1 } = q0 in
  if Z.eq_dec qnum0 qnum1 then Coq_Pos.eq_dec qden0 qden1 else false

(** val signal_dec : signal -> signal -> bool **)

let signal_dec x y =
  match x with
  | Place_lon -> (match y with
                  | Place_lon -> true
                  | _ -> false)
  | Place_lat -> (match y with
                  | Place_lat -> true
                  | _ -> false)
  | Speed_lon -> (match y with
                  | Speed_lon -> true
                  | _ -> false)
  | Speed_lat -> (match y with
                  | Speed_lat -> true
                  | _ -> false)
  | Acceleration_lon -> (match y with
                         | Acceleration_lon -> true
                         | _ -> false)
  | Acceleration_lat -> (match y with
                         | Acceleration_lat -> true
                         | _ -> false)
  | Jerk_lon -> (match y with
                 | Jerk_lon -> true
                 | _ -> false)
  | Own name -> (match y with
                 | Own name0 -> string_dec name name0
                 | _ -> false)

(** val term_dec : term -> term -> bool **)

let rec term_dec t0 x0 =
  match t0 with
  | Num q0 -> (match x0 with
               | Num q1 -> q_dec q0 q1
               | _ -> false)
  | Par name ->
    (match x0 with
     | Par name0 -> string_dec name name0
     | _ -> false)
  | Var name ->
    (match x0 with
     | Var name0 -> string_dec name name0
     | _ -> false)
  | Sig (n0, a) ->
    (match x0 with
     | Sig (n1, a0) -> if signal_dec n0 n1 then string_dec a a0 else false
     | _ -> false)
  | Siz (n0, a) ->
    (match x0 with
     | Siz (n1, a0) ->
       (match n0 with
        | Length -> (match n1 with
                     | Length -> string_dec a a0
                     | _ -> false)
        | Width -> (match n1 with
                    | Width -> string_dec a a0
                    | _ -> false)
        | Kind -> (match n1 with
                   | Kind -> string_dec a a0
                   | _ -> false))
     | _ -> false)
  | Add (x, y) ->
    (match x0 with
     | Add (x1, y0) -> if term_dec x x1 then term_dec y y0 else false
     | _ -> false)
  | Mul (x, y) ->
    (match x0 with
     | Mul (x1, y0) -> if term_dec x x1 then term_dec y y0 else false
     | _ -> false)
  | Pow (x, n0) ->
    (match x0 with
     | Pow (x1, n1) -> if term_dec x x1 then Nat.eq_dec n0 n1 else false
     | _ -> false)
  | Div (x, y) ->
    (match x0 with
     | Div (x1, y0) -> if term_dec x x1 then term_dec y y0 else false
     | _ -> false)
  | Max (x, y) ->
    (match x0 with
     | Max (x1, y0) -> if term_dec x x1 then term_dec y y0 else false
     | _ -> false)
  | Min (x, y) ->
    (match x0 with
     | Min (x1, y0) -> if term_dec x x1 then term_dec y y0 else false
     | _ -> false)

(** val side_dec : side -> side -> bool **)

let side_dec x y =
  match x with
  | Fin x0 -> (match y with
               | Fin x1 -> term_dec x0 x1
               | Inv _ -> false)
  | Inv x0 -> (match y with
               | Fin _ -> false
               | Inv x1 -> term_dec x0 x1)

(** val road_dec : road -> road -> bool **)

let road_dec x y =
  match x with
  | Free x0 -> (match y with
                | Free x1 -> string_dec x0 x1
                | Bound _ -> false)
  | Bound n0 -> (match y with
                 | Free _ -> false
                 | Bound n1 -> Nat.eq_dec n0 n1)

(** val zone_dec : zone -> zone -> bool **)

let zone_dec x y =
  match x with
  | Main -> (match y with
             | Main -> true
             | _ -> false)
  | Merge -> (match y with
              | Merge -> true
              | _ -> false)
  | Depart -> (match y with
               | Depart -> true
               | _ -> false)

(** val domain_dec : domain -> domain -> bool **)

let domain_dec x y =
  match x with
  | Lanes -> (match y with
              | Lanes -> true
              | _ -> false)
  | Adjacent l -> (match y with
                   | Adjacent l0 -> road_dec l l0
                   | _ -> false)
  | Lanelets l -> (match y with
                   | Lanelets l0 -> road_dec l l0
                   | _ -> false)
  | Zone z0 -> (match y with
                | Zone z1 -> zone_dec z0 z1
                | _ -> false)

(** val option_dec : term option -> term option -> bool **)

let option_dec x y =
  match x with
  | Some a -> (match y with
               | Some a0 -> term_dec a a0
               | None -> false)
  | None -> (match y with
             | Some _ -> false
             | None -> true)

(** val formula_dec : formula -> formula -> bool **)

let rec formula_dec f x0 =
  match f with
  | Truth b -> (match x0 with
                | Truth b0 -> bool_dec b b0
                | _ -> false)
  | Compare (l, o, r) ->
    (match x0 with
     | Compare (l0, o0, r0) ->
       if side_dec l l0
       then (match o with
             | LT -> (match o0 with
                      | LT -> side_dec r r0
                      | _ -> false)
             | LE -> (match o0 with
                      | LE -> side_dec r r0
                      | _ -> false)
             | GT -> (match o0 with
                      | GT -> side_dec r r0
                      | _ -> false)
             | GE -> (match o0 with
                      | GE -> side_dec r r0
                      | _ -> false))
       else false
     | _ -> false)
  | Occupies (a, l) ->
    (match x0 with
     | Occupies (a0, l0) -> if string_dec a a0 then road_dec l l0 else false
     | _ -> false)
  | Some_ (n0, d, f0) ->
    (match x0 with
     | Some_ (n1, d0, f1) ->
       if Nat.eq_dec n0 n1
       then if domain_dec d d0 then formula_dec f0 f1 else false
       else false
     | _ -> false)
  | Every (n0, d, f0) ->
    (match x0 with
     | Every (n1, d0, f1) ->
       if Nat.eq_dec n0 n1
       then if domain_dec d d0 then formula_dec f0 f1 else false
       else false
     | _ -> false)
  | Not f0 -> (match x0 with
               | Not f1 -> formula_dec f0 f1
               | _ -> false)
  | And (f0, g) ->
    (match x0 with
     | And (f1, g0) -> if formula_dec f0 f1 then formula_dec g g0 else false
     | _ -> false)
  | Or (f0, g) ->
    (match x0 with
     | Or (f1, g0) -> if formula_dec f0 f1 then formula_dec g g0 else false
     | _ -> false)
  | Until (f0, lo, hi, g) ->
    (match x0 with
     | Until (f1, lo0, hi0, g0) ->
       if formula_dec f0 f1
       then if term_dec lo lo0
            then if option_dec hi hi0 then formula_dec g g0 else false
            else false
       else false
     | _ -> false)
  | Eventually (lo, hi, f0) ->
    (match x0 with
     | Eventually (lo0, hi0, f1) ->
       if term_dec lo lo0
       then if option_dec hi hi0 then formula_dec f0 f1 else false
       else false
     | _ -> false)
  | Always (lo, hi, f0) ->
    (match x0 with
     | Always (lo0, hi0, f1) ->
       if term_dec lo lo0
       then if option_dec hi hi0 then formula_dec f0 f1 else false
       else false
     | _ -> false)

(** val same : formula -> formula -> bool **)

let same x y =
  if formula_dec x y then true else false

(** val road_inst : nat -> char list -> road -> road **)

let road_inst k c = function
| Free x -> Free x
| Bound n0 -> if Nat.eqb n0 k then Free c else Bound n0

(** val domain_inst : nat -> char list -> domain -> domain **)

let domain_inst k c d = match d with
| Adjacent l -> Adjacent (road_inst k c l)
| Lanelets l -> Lanelets (road_inst k c l)
| _ -> d

(** val inst : nat -> char list -> formula -> formula **)

let rec inst k c f = match f with
| Occupies (a, l) -> Occupies (a, (road_inst k c l))
| Some_ (n0, d, f0) ->
  Some_ (n0, (domain_inst k c d), (if Nat.eqb n0 k then f0 else inst k c f0))
| Every (n0, d, f0) ->
  Every (n0, (domain_inst k c d), (if Nat.eqb n0 k then f0 else inst k c f0))
| Not f0 -> Not (inst k c f0)
| And (f0, g) -> And ((inst k c f0), (inst k c g))
| Or (f0, g) -> Or ((inst k c f0), (inst k c g))
| Until (f0, lo, hi, g) -> Until ((inst k c f0), lo, hi, (inst k c g))
| Eventually (lo, hi, f0) -> Eventually (lo, hi, (inst k c f0))
| Always (lo, hi, f0) -> Always (lo, hi, (inst k c f0))
| _ -> f

(** val in_road : char list -> road -> bool **)

let in_road c = function
| Free x -> eqb0 x c
| Bound _ -> false

(** val in_domain : char list -> domain -> bool **)

let in_domain c = function
| Adjacent l -> in_road c l
| Lanelets l -> in_road c l
| _ -> false

(** val occurs : char list -> formula -> bool **)

let rec occurs c = function
| Occupies (_, l) -> in_road c l
| Some_ (_, d, f0) -> (||) (in_domain c d) (occurs c f0)
| Every (_, d, f0) -> (||) (in_domain c d) (occurs c f0)
| Not f0 -> occurs c f0
| And (f0, g) -> (||) (occurs c f0) (occurs c g)
| Or (f0, g) -> (||) (occurs c f0) (occurs c g)
| Until (f0, _, _, g) -> (||) (occurs c f0) (occurs c g)
| Eventually (_, _, f0) -> occurs c f0
| Always (_, _, f0) -> occurs c f0
| _ -> false

(** val term_rigid : term -> bool **)

let rec term_rigid = function
| Sig (_, _) -> false
| Add (x0, y) -> (&&) (term_rigid x0) (term_rigid y)
| Mul (x0, y) -> (&&) (term_rigid x0) (term_rigid y)
| Pow (x0, _) -> term_rigid x0
| Div (x0, y) -> (&&) (term_rigid x0) (term_rigid y)
| Max (x0, y) -> (&&) (term_rigid x0) (term_rigid y)
| Min (x0, y) -> (&&) (term_rigid x0) (term_rigid y)
| _ -> true

(** val side_rigid : side -> bool **)

let side_rigid = function
| Fin x -> term_rigid x
| Inv x -> term_rigid x

(** val rigid : formula -> bool **)

let rec rigid = function
| Truth _ -> true
| Compare (l, _, r) -> (&&) (side_rigid l) (side_rigid r)
| Not f0 -> rigid f0
| And (f0, g) -> (&&) (rigid f0) (rigid g)
| Or (f0, g) -> (&&) (rigid f0) (rigid g)
| _ -> false

type fact =
| At of bool * vec * formula
| Throughout of vec * vec * formula
| Belongs of bool * domain * char list

type tree =
| CloseTruth of nat
| Close of nat * nat * wit * wit
| CloseLinear of wit
| CloseRoad of nat
| CloseRoads of nat * nat
| CloseZones of nat * nat * nat
| Alpha of nat * tree
| Beta of nat * tree * tree
| Timing of nat * tree
| New of nat * nat * tree
| Inst of nat * vec * wit * wit * tree
| InstUntil of nat * vec * wit * wit * nat * tree * tree
| NewRoad of nat * char list * tree
| InstRoad of nat * char list * tree * tree
| Cut of vec * tree * tree
| Fact of nat * vec * tree

(** val index : char list -> char list list -> nat option **)

let rec index p = function
| [] -> None
| q0 :: ps0 ->
  if eqb0 q0 p then Some O else option_map (fun x -> S x) (index p ps0)

(** val linear : char list list -> term -> vec option **)

let rec linear ps = function
| Num q0 -> Some (q0 :: [])
| Par p -> option_map (fun i -> unit1 (S i)) (index p ps)
| Add (x0, y) ->
  (match linear ps x0 with
   | Some u ->
     (match linear ps y with
      | Some v -> Some (vadd u v)
      | None -> None)
   | None -> None)
| Mul (x0, y) ->
  (match linear ps x0 with
   | Some v ->
     (match v with
      | [] ->
        (match linear ps y with
         | Some v0 ->
           (match v0 with
            | [] -> None
            | q0 :: l ->
              (match l with
               | [] -> Some (vscale q0 v)
               | _ :: _ -> None))
         | None -> None)
      | q0 :: l ->
        (match l with
         | [] ->
           (match linear ps y with
            | Some v0 -> Some (vscale q0 v0)
            | None -> None)
         | _ :: _ ->
           (match linear ps y with
            | Some v0 ->
              (match v0 with
               | [] -> None
               | q1 :: l1 ->
                 (match l1 with
                  | [] -> Some (vscale q1 v)
                  | _ :: _ -> None))
            | None -> None)))
   | None -> None)
| Div (x0, y) ->
  (match linear ps x0 with
   | Some v ->
     (match linear ps y with
      | Some v0 ->
        (match v0 with
         | [] -> None
         | q0 :: l ->
           (match l with
            | [] ->
              if qeq_bool q0 { qnum = Z0; qden = XH }
              then None
              else Some (vscale (qinv q0) v)
            | _ :: _ -> None))
      | None -> None)
   | None -> None)
| _ -> None

(** val window :
    char list list -> vec -> term -> term option -> (vec * vec option) option **)

let window ps m lo hi =
  match linear ps lo with
  | Some a ->
    (match hi with
     | Some b ->
       option_map (fun b0 -> ((vadd m a), (Some (vadd m b0)))) (linear ps b)
     | None -> Some ((vadd m a), None))
  | None -> None

(** val window_cons : nat -> (vec * vec option) -> con list -> con list **)

let window_cons n0 w c =
  let c1 = (false, (vsub (unit1 n0) (fst w))) :: c in
  (match snd w with
   | Some b -> (false, (vsub b (unit1 n0))) :: c1
   | None -> c1)

(** val inside :
    con list -> vec -> (vec * vec option) -> wit -> wit -> bool **)

let inside c m w w1 w2 =
  (&&) (entails c (vsub m (fst w)) w1)
    (match snd w with
     | Some b -> entails c (vsub b m) w2
     | None -> true)

(** val fits : nat -> (vec * vec option) -> bool **)

let fits n0 w =
  (&&) (Nat.leb (length (fst w)) n0)
    (match snd w with
     | Some b -> Nat.leb (length b) n0
     | None -> true)

(** val dimension : fact -> nat **)

let dimension = function
| At (_, m, _) -> length m
| Throughout (lo, hi, _) -> Nat.max (length lo) (length hi)
| Belongs (_, _, _) -> O

(** val fresh : char list list -> nat -> fact list -> con list -> bool **)

let fresh ps n0 g c =
  (&&)
    ((&&) (Nat.ltb (length ps) n0)
      (forallb (fun f -> Nat.leb (dimension f) n0) g))
    (forallb (fun c0 -> Nat.leb (length (snd c0)) n0) c)

(** val fact_occurs : char list -> fact -> bool **)

let fact_occurs c = function
| At (_, _, f0) -> occurs c f0
| Throughout (_, _, f0) -> occurs c f0
| Belongs (_, d, x) -> (||) (in_domain c d) (eqb0 x c)

(** val timing :
    char list list -> bool -> side -> comparison0 -> side -> con option **)

let timing ps b l o r =
  match l with
  | Fin x ->
    (match r with
     | Fin y ->
       (match linear ps x with
        | Some u ->
          (match linear ps y with
           | Some v ->
             (match o with
              | LT ->
                if b
                then Some (true, (vsub v u))
                else Some (false, (vsub u v))
              | LE ->
                if b
                then Some (false, (vsub v u))
                else Some (true, (vsub u v))
              | GT ->
                if b
                then Some (true, (vsub u v))
                else Some (false, (vsub v u))
              | GE ->
                if b
                then Some (false, (vsub u v))
                else Some (true, (vsub v u)))
           | None -> None)
        | None -> None)
     | Inv _ -> None)
  | Inv _ -> None

(** val no_road : bool -> domain -> char list -> bool **)

let no_road b d c =
  if b
  then (match d with
        | Adjacent l -> (match l with
                         | Free x -> eqb0 x c
                         | Bound _ -> false)
        | _ -> false)
  else (match d with
        | Lanes -> true
        | Lanelets l -> (match l with
                         | Free x -> eqb0 x c
                         | Bound _ -> false)
        | _ -> false)

(** val no_roads :
    bool -> domain -> char list -> bool -> domain -> char list -> bool **)

let no_roads b d c b' d' c' =
  (||)
    ((&&) ((&&) ((&&) b (negb b')) (eqb0 c c'))
      (if domain_dec d d' then true else false))
    (if b
     then (match d with
           | Adjacent l ->
             (match l with
              | Free x ->
                if b'
                then false
                else (match d' with
                      | Adjacent l0 ->
                        (match l0 with
                         | Free y -> (&&) (eqb0 x c') (eqb0 y c)
                         | Bound _ -> false)
                      | _ -> false)
              | Bound _ -> false)
           | Zone z0 ->
             if b'
             then (match d' with
                   | Zone z' ->
                     (&&) (eqb0 c c') (if zone_dec z0 z' then false else true)
                   | _ -> false)
             else false
           | _ -> false)
     else false)

(** val check :
    char list list -> formula list -> fact list -> con list -> tree -> bool **)

let rec check ps facts g c = function
| CloseTruth i ->
  (match get i g with
   | Some f ->
     (match f with
      | At (b, _, f0) -> (match f0 with
                          | Truth b' -> xorb b b'
                          | _ -> false)
      | _ -> false)
   | None -> false)
| Close (i, j, w1, w2) ->
  (match get i g with
   | Some f0 ->
     (match f0 with
      | At (b, m, f) ->
        if b
        then (match get j g with
              | Some f1 ->
                (match f1 with
                 | At (b0, m', g0) ->
                   if b0
                   then false
                   else (&&) (same f g0)
                          ((||) (rigid f)
                            ((&&) (entails c (vsub m m') w1)
                              (entails c (vsub m' m) w2)))
                 | _ -> false)
              | None -> false)
        else false
      | _ -> false)
   | None -> false)
| CloseLinear w -> farkas c w
| CloseRoad i ->
  (match get i g with
   | Some f ->
     (match f with
      | Belongs (b, d, c0) -> no_road b d c0
      | _ -> false)
   | None -> false)
| CloseRoads (i, j) ->
  (match get i g with
   | Some f ->
     (match f with
      | Belongs (b, d, c0) ->
        (match get j g with
         | Some f0 ->
           (match f0 with
            | Belongs (b', d', c') -> no_roads b d c0 b' d' c'
            | _ -> false)
         | None -> false)
      | _ -> false)
   | None -> false)
| CloseZones (i, j, k) ->
  (match get i g with
   | Some f ->
     (match f with
      | Belongs (b, d, c0) ->
        if b
        then false
        else (match d with
              | Zone z0 ->
                (match z0 with
                 | Main ->
                   (match get j g with
                    | Some f0 ->
                      (match f0 with
                       | Belongs (b0, d0, c') ->
                         if b0
                         then false
                         else (match d0 with
                               | Zone z1 ->
                                 (match z1 with
                                  | Merge ->
                                    (match get k g with
                                     | Some f1 ->
                                       (match f1 with
                                        | Belongs (b1, d1, c'') ->
                                          if b1
                                          then false
                                          else (match d1 with
                                                | Zone z2 ->
                                                  (match z2 with
                                                   | Depart ->
                                                     (&&) (eqb0 c0 c')
                                                       (eqb0 c0 c'')
                                                   | _ -> false)
                                                | _ -> false)
                                        | _ -> false)
                                     | None -> false)
                                  | _ -> false)
                               | _ -> false)
                       | _ -> false)
                    | None -> false)
                 | _ -> false)
              | _ -> false)
      | _ -> false)
   | None -> false)
| Alpha (i, t0) ->
  (match get i g with
   | Some f0 ->
     (match f0 with
      | At (b, m, f1) ->
        if b
        then (match f1 with
              | Not f -> check ps facts ((At ((negb b), m, f)) :: g) c t0
              | And (f, g0) ->
                check ps facts ((At (true, m, g0)) :: ((At (true, m,
                  f)) :: g)) c t0
              | _ -> false)
        else (match f1 with
              | Not f -> check ps facts ((At ((negb b), m, f)) :: g) c t0
              | Or (f, g0) ->
                check ps facts ((At (false, m, g0)) :: ((At (false, m,
                  f)) :: g)) c t0
              | _ -> false)
      | _ -> false)
   | None -> false)
| Beta (i, t1, t2) ->
  (match get i g with
   | Some f0 ->
     (match f0 with
      | At (b, m, f1) ->
        if b
        then (match f1 with
              | Or (f, g0) ->
                (&&) (check ps facts ((At (true, m, f)) :: g) c t1)
                  (check ps facts ((At (true, m, g0)) :: g) c t2)
              | _ -> false)
        else (match f1 with
              | And (f, g0) ->
                (&&) (check ps facts ((At (false, m, f)) :: g) c t1)
                  (check ps facts ((At (false, m, g0)) :: g) c t2)
              | _ -> false)
      | _ -> false)
   | None -> false)
| Timing (i, t0) ->
  (match get i g with
   | Some f ->
     (match f with
      | At (b, _, f0) ->
        (match f0 with
         | Compare (l, o, r) ->
           (match timing ps b l o r with
            | Some c0 -> check ps facts g (c0 :: c) t0
            | None -> false)
         | _ -> false)
      | _ -> false)
   | None -> false)
| New (i, n0, t0) ->
  (&&) (fresh ps n0 g c)
    (match get i g with
     | Some f0 ->
       (match f0 with
        | At (b, m, f1) ->
          if b
          then (match f1 with
                | Until (f, lo, hi, g0) ->
                  (match window ps m lo hi with
                   | Some w ->
                     (&&) (fits n0 w)
                       (check ps facts ((Throughout ((fst w), (unit1 n0),
                         f)) :: ((At (true, (unit1 n0), g0)) :: g))
                         (window_cons n0 w c) t0)
                   | None -> false)
                | Eventually (lo, hi, f) ->
                  (match window ps m lo hi with
                   | Some w ->
                     (&&) (fits n0 w)
                       (check ps facts ((At (true, (unit1 n0), f)) :: g)
                         (window_cons n0 w c) t0)
                   | None -> false)
                | _ -> false)
          else (match f1 with
                | Always (lo, hi, f) ->
                  (match window ps m lo hi with
                   | Some w ->
                     (&&) (fits n0 w)
                       (check ps facts ((At (false, (unit1 n0), f)) :: g)
                         (window_cons n0 w c) t0)
                   | None -> false)
                | _ -> false)
        | _ -> false)
     | None -> false)
| Inst (i, m, w1, w2, t0) ->
  (match get i g with
   | Some f0 ->
     (match f0 with
      | At (b, m0, f1) ->
        if b
        then (match f1 with
              | Always (lo, hi, f) ->
                (match window ps m0 lo hi with
                 | Some w ->
                   (&&) (inside c m w w1 w2)
                     (check ps facts ((At (true, m, f)) :: g) c t0)
                 | None -> false)
              | _ -> false)
        else (match f1 with
              | Eventually (lo, hi, f) ->
                (match window ps m0 lo hi with
                 | Some w ->
                   (&&) (inside c m w w1 w2)
                     (check ps facts ((At (false, m, f)) :: g) c t0)
                 | None -> false)
              | _ -> false)
      | Throughout (lo, hi, f) ->
        (&&) ((&&) (entails c (vsub m lo) w1) (entails_lt c (vsub hi m) w2))
          (check ps facts ((At (true, m, f)) :: g) c t0)
      | Belongs (_, _, _) -> false)
   | None -> false)
| InstUntil (i, m, w1, w2, n0, t1, t2) ->
  (match get i g with
   | Some f0 ->
     (match f0 with
      | At (b, m0, f1) ->
        if b
        then false
        else (match f1 with
              | Until (f, lo, hi, g0) ->
                (match window ps m0 lo hi with
                 | Some w ->
                   (&&)
                     ((&&)
                       ((&&)
                         ((&&)
                           ((&&) (inside c m w w1 w2)
                             (check ps facts ((At (false, m, g0)) :: g) c t1))
                           (fresh ps n0 g c)) (fits n0 w))
                       (Nat.leb (length m) n0))
                     (check ps facts ((At (false, (unit1 n0), f)) :: g)
                       ((true, (vsub m (unit1 n0))) :: ((false,
                       (vsub (unit1 n0) (fst w))) :: c)) t2)
                 | None -> false)
              | _ -> false)
      | _ -> false)
   | None -> false)
| NewRoad (i, c0, t0) ->
  (&&) (forallb (fun f -> negb (fact_occurs c0 f)) g)
    (match get i g with
     | Some f0 ->
       (match f0 with
        | At (b, m, f1) ->
          if b
          then (match f1 with
                | Some_ (n0, d, f) ->
                  check ps facts ((At (true, m, (inst n0 c0 f))) :: ((Belongs
                    (true, d, c0)) :: g)) c t0
                | _ -> false)
          else (match f1 with
                | Every (n0, d, f) ->
                  check ps facts ((At (false, m,
                    (inst n0 c0 f))) :: ((Belongs (true, d, c0)) :: g)) c t0
                | _ -> false)
        | _ -> false)
     | None -> false)
| InstRoad (i, c0, t1, t2) ->
  (match get i g with
   | Some f0 ->
     (match f0 with
      | At (b, m, f1) ->
        if b
        then (match f1 with
              | Every (n0, d, f) ->
                (&&) (check ps facts ((Belongs (false, d, c0)) :: g) c t1)
                  (check ps facts ((At (true, m, (inst n0 c0 f))) :: g) c t2)
              | _ -> false)
        else (match f1 with
              | Some_ (n0, d, f) ->
                (&&) (check ps facts ((Belongs (false, d, c0)) :: g) c t1)
                  (check ps facts ((At (false, m, (inst n0 c0 f))) :: g) c t2)
              | _ -> false)
      | _ -> false)
   | None -> false)
| Cut (v, t1, t2) ->
  (&&) (check ps facts g ((false, v) :: c) t1)
    (check ps facts g ((true,
      (vscale { qnum = (Zneg XH); qden = XH } v)) :: c) t2)
| Fact (k, m, t0) ->
  (match nth_error facts k with
   | Some f -> check ps facts ((At (true, m, f)) :: g) c t0
   | None -> false)

(** val bound_cons : char list list -> bound list -> con list **)

let rec bound_cons ps = function
| [] -> []
| b :: bounds0 ->
  let named =
    match b with
    | At_least_0 p -> Some (p, false)
    | Above_0 p -> Some (p, true)
    | _ -> None
  in
  (match named with
   | Some p2 ->
     let (p, strict) = p2 in
     (match index p ps with
      | Some i -> (strict, (unit1 (S i))) :: (bound_cons ps bounds0)
      | None -> bound_cons ps bounds0)
   | None -> bound_cons ps bounds0)

(** val accepts :
    char list list -> bound list -> formula list -> formula -> tree -> bool **)

let accepts ps bounds facts claim tr =
  check ps facts ((At (false, [], claim)) :: []) (bound_cons ps bounds) tr

type values = (char list * q) list

(** val value_of : char list -> values -> q option **)

let rec value_of p = function
| [] -> None
| p2 :: vs0 ->
  let (p', q0) = p2 in if eqb0 p' p then Some q0 else value_of p vs0

(** val put_term : values -> term -> term **)

let rec put_term vs x = match x with
| Par p -> (match value_of p vs with
            | Some q0 -> Num q0
            | None -> Par p)
| Add (x0, y) -> Add ((put_term vs x0), (put_term vs y))
| Mul (x0, y) -> Mul ((put_term vs x0), (put_term vs y))
| Pow (x0, n0) -> Pow ((put_term vs x0), n0)
| Div (x0, y) -> Div ((put_term vs x0), (put_term vs y))
| Max (x0, y) -> Max ((put_term vs x0), (put_term vs y))
| Min (x0, y) -> Min ((put_term vs x0), (put_term vs y))
| _ -> x

(** val put_side : values -> side -> side **)

let put_side vs = function
| Fin x -> Fin (put_term vs x)
| Inv x -> Inv (put_term vs x)

(** val put : values -> formula -> formula **)

let rec put vs f = match f with
| Compare (l, o, r) -> Compare ((put_side vs l), o, (put_side vs r))
| Some_ (n0, d, f0) -> Some_ (n0, d, (put vs f0))
| Every (n0, d, f0) -> Every (n0, d, (put vs f0))
| Not f0 -> Not (put vs f0)
| And (f0, g) -> And ((put vs f0), (put vs g))
| Or (f0, g) -> Or ((put vs f0), (put vs g))
| Until (f0, lo, hi, g) ->
  Until ((put vs f0), (put_term vs lo), (option_map (put_term vs) hi),
    (put vs g))
| Eventually (lo, hi, f0) ->
  Eventually ((put_term vs lo), (option_map (put_term vs) hi), (put vs f0))
| Always (lo, hi, f0) ->
  Always ((put_term vs lo), (option_map (put_term vs) hi), (put vs f0))
| _ -> f

(** val bounds_it : bool -> q -> vec -> bool **)

let bounds_it up q0 = function
| [] -> false
| a :: l ->
  (match l with
   | [] -> false
   | k :: l0 ->
     (match l0 with
      | [] ->
        (&&) (qle_bool (qplus a (qmult k q0)) { qnum = Z0; qden = XH })
          (negb
            (if up
             then qle_bool { qnum = Z0; qden = XH } k
             else qle_bool k { qnum = Z0; qden = XH }))
      | _ :: _ -> false))

(** val demands : bool -> char list -> q -> bool -> formula -> bool **)

let rec demands up p q0 b = function
| Compare (l, o, r) ->
  (match timing (p :: []) b l o r with
   | Some c -> let (_, v) = c in bounds_it up q0 v
   | None -> false)
| Some_ (_, _, f0) -> (&&) b (demands up p q0 b f0)
| Every (_, _, f0) -> (&&) (negb b) (demands up p q0 b f0)
| Not f0 -> demands up p q0 (negb b) f0
| And (f0, g) ->
  if b
  then (||) (demands up p q0 b f0) (demands up p q0 b g)
  else (&&) (demands up p q0 b f0) (demands up p q0 b g)
| Or (f0, g) ->
  if b
  then (&&) (demands up p q0 b f0) (demands up p q0 b g)
  else (||) (demands up p q0 b f0) (demands up p q0 b g)
| Until (_, _, _, f0) -> (&&) b (demands up p q0 b f0)
| Eventually (_, _, f0) -> (&&) b (demands up p q0 b f0)
| Always (_, _, f0) -> (&&) (negb b) (demands up p q0 b f0)
| _ -> false

(** val all_demanded : values -> formula -> bool **)

let all_demanded vs claim =
  forallb (fun x ->
    (&&) (demands true (fst x) (snd x) false claim)
      (demands false (fst x) (snd x) false claim)) vs

(** val accepts_at :
    char list list -> bound list -> formula list -> values -> formula -> tree
    -> bool **)

let accepts_at ps bounds facts vs claim tr =
  (&&) (all_demanded vs claim) (accepts ps bounds facts (put vs claim) tr)

(** val plus_q : q -> q -> q **)

let plus_q x y =
  qred (qplus x y)

(** val minus_q : q -> q -> q **)

let minus_q x y =
  qred (qminus x y)

(** val times_q : q -> q -> q **)

let times_q x y =
  qred (qmult x y)

type poly = q pExpr

(** val normal : poly -> q pol **)

let normal =
  norm { qnum = Z0; qden = XH } { qnum = (Zpos XH); qden = XH } plus_q
    times_q minus_q qopp qeq_bool

type constraint0 = q nFormula

(** val above : poly -> constraint0 **)

let above p =
  ((normal p), Strict)

(** val at_least : poly -> constraint0 **)

let at_least p =
  ((normal p), NonStrict)

(** val zero0 : poly -> constraint0 **)

let zero0 p =
  ((normal p), Equal)

(** val c_ : z -> positive -> poly **)

let c_ z0 n0 =
  PEc { qnum = z0; qden = n0 }

(** val x_ : positive -> poly **)

let x_ n0 =
  PEX n0

(** val given_ : nat -> q psatz **)

let given_ i =
  PsatzIn i

(** val number_ : z -> positive -> q psatz **)

let number_ z0 n0 =
  PsatzC { qnum = z0; qden = n0 }

(** val square_ : poly -> q psatz **)

let square_ p =
  PsatzSquare (normal p)

(** val times_ : poly -> q psatz -> q psatz **)

let times_ p w =
  PsatzMulC ((normal p), w)

type reason =
| Absurd of q psatz
| Untrue of nat
| Opposed of nat * nat
| Both of nat * reason
| Either of nat * reason * reason
| Plain of nat * reason
| Reads of nat * reason
| Sized of size * vehicle * reason
| Largest of term * term * reason * reason
| Smallest of term * term * reason * reason
| Over of term * term * bool * q psatz * reason
| Sign of poly * reason * reason

type table = (term * poly) list

(** val look : table -> term -> poly option **)

let rec look t0 x =
  match t0 with
  | [] -> None
  | p2 :: t1 -> let (y, p) = p2 in if term_dec x y then Some p else look t1 x

(** val two :
    ('a1 -> 'a1 -> 'a2) -> 'a1 option -> 'a1 option -> 'a2 option **)

let two f x y =
  match x with
  | Some x0 -> (match y with
                | Some y0 -> Some (f x0 y0)
                | None -> None)
  | None -> None

(** val polynomial : table -> term -> poly option **)

let rec polynomial t0 x =
  match look t0 x with
  | Some p -> Some p
  | None ->
    (match x with
     | Num q0 -> Some (PEc q0)
     | Add (x0, y) ->
       two (fun x1 x2 -> PEadd (x1, x2)) (polynomial t0 x0) (polynomial t0 y)
     | Mul (x0, y) ->
       two (fun x1 x2 -> PEmul (x1, x2)) (polynomial t0 x0) (polynomial t0 y)
     | Pow (x0, n0) ->
       option_map (fun p -> PEpow (p, (N.of_nat n0))) (polynomial t0 x0)
     | Div (x0, y) ->
       (match y with
        | Num q0 ->
          if qeq_bool q0 { qnum = Z0; qden = XH }
          then None
          else option_map (fun x1 -> PEmul ((PEc (qinv q0)), x1))
                 (polynomial t0 x0)
        | _ -> None)
     | _ -> None)

(** val reading : table -> bool -> formula -> constraint0 option **)

let reading t0 b = function
| Compare (l, o, r) ->
  (match l with
   | Fin x ->
     (match r with
      | Fin y ->
        (match polynomial t0 x with
         | Some p ->
           (match polynomial t0 y with
            | Some q0 ->
              Some
                (match o with
                 | LT ->
                   if b
                   then above (PEsub (q0, p))
                   else at_least (PEsub (p, q0))
                 | LE ->
                   if b
                   then at_least (PEsub (q0, p))
                   else above (PEsub (p, q0))
                 | GT ->
                   if b
                   then above (PEsub (p, q0))
                   else at_least (PEsub (q0, p))
                 | GE ->
                   if b
                   then at_least (PEsub (p, q0))
                   else above (PEsub (q0, p)))
            | None -> None)
         | None -> None)
      | Inv _ -> None)
   | Inv _ -> None)
| _ -> None

(** val inverse_of : term -> term **)

let inverse_of x =
  Div ((Num { qnum = (Zpos XH); qden = XH }), x)

(** val is_zero : term -> formula **)

let is_zero x =
  And ((Compare ((Fin (Num { qnum = Z0; qden = XH })), LE, (Fin x))),
    (Compare ((Fin x), LE, (Fin (Num { qnum = Z0; qden = XH })))))

(** val lower : comparison0 -> side -> side -> formula **)

let lower o a b =
  match a with
  | Fin x ->
    (match b with
     | Fin _ -> Compare (a, o, b)
     | Inv y -> Or ((is_zero y), (Compare ((Fin x), o, (Fin (inverse_of y))))))
  | Inv x ->
    (match b with
     | Fin y ->
       And ((Not (is_zero x)), (Compare ((Fin (inverse_of x)), o, (Fin y))))
     | Inv y ->
       (match o with
        | LE ->
          Or ((is_zero y), (And ((Not (is_zero x)), (Compare ((Fin
            (inverse_of x)), o, (Fin (inverse_of y)))))))
        | _ ->
          And ((Not (is_zero x)), (Or ((is_zero y), (Compare ((Fin
            (inverse_of x)), o, (Fin (inverse_of y)))))))))

(** val plain : formula -> formula **)

let plain f = match f with
| Compare (a, o, b) ->
  (match o with
   | GT -> lower LT b a
   | GE -> lower LE b a
   | x -> lower x a b)
| _ -> f

type fact0 = bool * formula

(** val contradicts : constraint0 list -> q psatz -> bool **)

let contradicts =
  check_normalised_formulas { qnum = Z0; qden = XH } { qnum = (Zpos XH);
    qden = XH } plus_q times_q qeq_bool qle_bool

(** val refutes : constraint0 list -> constraint0 -> q psatz -> bool **)

let refutes c c0 w =
  contradicts (c0 :: c) w

(** val check0 : table -> fact0 list -> constraint0 list -> reason -> bool **)

let rec check0 t0 g c = function
| Absurd w -> contradicts c w
| Untrue i ->
  (match nth_error g i with
   | Some f ->
     let (b, f0) = f in (match f0 with
                         | Truth b' -> xorb b b'
                         | _ -> false)
   | None -> false)
| Opposed (i, j) ->
  (match nth_error g i with
   | Some f0 ->
     let (b, f) = f0 in
     if b
     then (match nth_error g j with
           | Some f1 -> let (b0, g0) = f1 in if b0 then false else same f g0
           | None -> false)
     else false
   | None -> false)
| Both (i, t1) ->
  (match nth_error g i with
   | Some f0 ->
     let (b, f1) = f0 in
     if b
     then (match f1 with
           | Not f -> check0 t0 (((negb b), f) :: g) c t1
           | And (f, g0) -> check0 t0 ((true, g0) :: ((true, f) :: g)) c t1
           | _ -> false)
     else (match f1 with
           | Not f -> check0 t0 (((negb b), f) :: g) c t1
           | Or (f, g0) -> check0 t0 ((false, g0) :: ((false, f) :: g)) c t1
           | _ -> false)
   | None -> false)
| Either (i, t1, t2) ->
  (match nth_error g i with
   | Some f0 ->
     let (b, f1) = f0 in
     if b
     then (match f1 with
           | Or (f, g0) ->
             (&&) (check0 t0 ((true, f) :: g) c t1)
               (check0 t0 ((true, g0) :: g) c t2)
           | _ -> false)
     else (match f1 with
           | And (f, g0) ->
             (&&) (check0 t0 ((false, f) :: g) c t1)
               (check0 t0 ((false, g0) :: g) c t2)
           | _ -> false)
   | None -> false)
| Plain (i, t1) ->
  (match nth_error g i with
   | Some f0 -> let (b, f) = f0 in check0 t0 ((b, (plain f)) :: g) c t1
   | None -> false)
| Reads (i, t1) ->
  (match nth_error g i with
   | Some f0 ->
     let (b, f) = f0 in
     (match reading t0 b f with
      | Some c0 -> check0 t0 g (c0 :: c) t1
      | None -> false)
   | None -> false)
| Sized (n0, a, t1) ->
  (match polynomial t0 (Siz (n0, a)) with
   | Some p -> check0 t0 g ((above p) :: c) t1
   | None -> false)
| Largest (x, y, t1, t2) ->
  (match polynomial t0 x with
   | Some p ->
     (match polynomial t0 y with
      | Some q0 ->
        (&&)
          (check0 (((Max (x, y)), q0) :: t0) g
            ((at_least (PEsub (q0, p))) :: c) t1)
          (check0 (((Max (x, y)), p) :: t0) g ((above (PEsub (p, q0))) :: c)
            t2)
      | None -> false)
   | None -> false)
| Smallest (x, y, t1, t2) ->
  (match polynomial t0 x with
   | Some p ->
     (match polynomial t0 y with
      | Some q0 ->
        (&&)
          (check0 (((Min (x, y)), p) :: t0) g
            ((at_least (PEsub (q0, p))) :: c) t1)
          (check0 (((Min (x, y)), q0) :: t0) g ((above (PEsub (p, q0))) :: c)
            t2)
      | None -> false)
   | None -> false)
| Over (x, y, up, w, t1) ->
  (match polynomial t0 x with
   | Some p ->
     (match polynomial t0 y with
      | Some q0 ->
        (match polynomial t0 (Div (x, y)) with
         | Some r ->
           (&&) (refutes c (at_least (if up then PEopp q0 else q0)) w)
             (check0 t0 g ((zero0 (PEsub ((PEmul (r, q0)), p))) :: c) t1)
         | None -> false)
      | None -> false)
   | None -> false)
| Sign (p, t1, t2) ->
  (&&) (check0 t0 g ((at_least p) :: c) t1)
    (check0 t0 g ((above (PEopp p)) :: c) t2)

(** val numbered : positive -> term list -> table **)

let rec numbered n0 = function
| [] -> []
| x :: xs0 -> (x, (PEX n0)) :: (numbered (Coq_Pos.succ n0) xs0)

(** val known_of : table -> bound -> constraint0 option **)

let known_of t0 = function
| At_least_0 p -> option_map at_least (polynomial t0 (Par p))
| Above_0 p -> option_map above (polynomial t0 (Par p))
| Own_at_least (n0, a, low) ->
  option_map (fun e -> at_least (PEsub (e, (PEc low))))
    (polynomial t0 (Sig ((Own n0), a)))
| Own_at_most (n0, a, high) ->
  option_map (fun e -> at_least (PEsub ((PEc high), e)))
    (polynomial t0 (Sig ((Own n0), a)))

(** val known : table -> bound list -> constraint0 list **)

let rec known t0 = function
| [] -> []
| b :: bounds0 ->
  (match known_of t0 b with
   | Some c -> c :: (known t0 bounds0)
   | None -> known t0 bounds0)

(** val settles : bound list -> term list -> formula -> reason -> bool **)

let settles bounds xs f tr =
  let t0 = numbered XH xs in check0 t0 ((false, f) :: []) (known t0 bounds) tr

(** val a_max : term **)

let a_max =
  Par ('a'::('_'::('m'::('a'::('x'::[])))))

(** val b_max : term **)

let b_max =
  Par ('b'::('_'::('m'::('a'::('x'::[])))))

(** val b_min : term **)

let b_min =
  Par ('b'::('_'::('m'::('i'::('n'::[])))))

(** val rho : term **)

let rho =
  Par ('r'::('h'::('o'::[])))

(** val v_r : term **)

let v_r =
  Var ('v'::('_'::('r'::[])))

(** val v_f : term **)

let v_f =
  Var ('v'::('_'::('f'::[])))

(** val gap : term **)

let gap =
  Var ('g'::('a'::('p'::[])))

(** val t : term **)

let t =
  Var ('t'::[])

(** val guarantee_bounds : bound list **)

let guarantee_bounds =
  (At_least_0 ('a'::('_'::('m'::('a'::('x'::[])))))) :: ((Above_0
    ('b'::('_'::('m'::('a'::('x'::[])))))) :: ((Above_0
    ('b'::('_'::('m'::('i'::('n'::[])))))) :: ((At_least_0
    ('r'::('h'::('o'::[])))) :: [])))

(** val guarantee : formula **)

let guarantee =
  Or ((Not (Compare ((Fin b_min), LE, (Fin b_max)))), (Or ((Not (And
    ((Compare ((Fin (Num { qnum = Z0; qden = XH })), LE, (Fin v_r))), (And
    ((Compare ((Fin (Num { qnum = Z0; qden = XH })), LE, (Fin v_f))), (And
    ((Compare ((Fin (Num { qnum = Z0; qden = XH })), LE, (Fin t))), (Compare
    ((Fin gap), GT, (Fin (Max ((Num { qnum = Z0; qden = XH }), (Add ((Add
    ((Add ((Mul (v_r, rho)), (Div ((Mul (a_max, (Pow (rho, (S (S O)))))),
    (Num { qnum = (Zpos (XO XH)); qden = XH }))))), (Div ((Pow ((Add (v_r,
    (Mul (a_max, rho)))), (S (S O)))), (Mul ((Num { qnum = (Zpos (XO XH));
    qden = XH }), b_min)))))), (Mul ((Num { qnum = (Zneg XH); qden = XH }),
    (Div ((Pow (v_f, (S (S O)))), (Mul ((Num { qnum = (Zpos (XO XH)); qden =
    XH }), b_max)))))))))))))))))))), (Compare ((Fin (Add ((Add (gap, (Add
    ((Mul (v_f, (Min (t, (Div (v_f, b_max)))))), (Mul ((Num { qnum = (Zneg
    XH); qden = XH }), (Div ((Mul (b_max, (Pow ((Min (t, (Div (v_f,
    b_max)))), (S (S O)))))), (Num { qnum = (Zpos (XO XH)); qden =
    XH }))))))))), (Mul ((Num { qnum = (Zneg XH); qden = XH }), (Add ((Add
    ((Mul (v_r, (Min (t, rho)))), (Div ((Mul (a_max, (Pow ((Min (t, rho)), (S
    (S O)))))), (Num { qnum = (Zpos (XO XH)); qden = XH }))))), (Add ((Mul
    ((Add (v_r, (Mul (a_max, rho)))), (Min ((Max ((Num { qnum = Z0; qden =
    XH }), (Add (t, (Mul ((Num { qnum = (Zneg XH); qden = XH }), rho)))))),
    (Div ((Add (v_r, (Mul (a_max, rho)))), b_min)))))), (Mul ((Num { qnum =
    (Zneg XH); qden = XH }), (Div ((Mul (b_min, (Pow ((Min ((Max ((Num
    { qnum = Z0; qden = XH }), (Add (t, (Mul ((Num { qnum = (Zneg XH); qden =
    XH }), rho)))))), (Div ((Add (v_r, (Mul (a_max, rho)))), b_min)))), (S (S
    O)))))), (Num { qnum = (Zpos (XO XH)); qden = XH })))))))))))))), GT,
    (Fin (Num { qnum = Z0; qden = XH })))))))

(** val bound_dec : bound -> bound -> bool **)

let bound_dec x y =
  match x with
  | At_least_0 name ->
    (match y with
     | At_least_0 name0 -> string_dec name name0
     | _ -> false)
  | Above_0 name ->
    (match y with
     | Above_0 name0 -> string_dec name name0
     | _ -> false)
  | Own_at_least (name, a, low) ->
    (match y with
     | Own_at_least (name0, a0, low0) ->
       if string_dec name name0
       then if string_dec a a0 then q_dec low low0 else false
       else false
     | _ -> false)
  | Own_at_most (name, a, high) ->
    (match y with
     | Own_at_most (name0, a0, high0) ->
       if string_dec name name0
       then if string_dec a a0 then q_dec high high0 else false
       else false
     | _ -> false)

(** val among : bound list -> bound -> bool **)

let among bounds b =
  if in_dec bound_dec b bounds then true else false

(** val is_known : bound list -> formula -> bool **)

let is_known bounds f =
  (&&) (same f guarantee) (forallb (among bounds) guarantee_bounds)

(** val plus : q -> q -> q **)

let plus a b =
  qred (qplus a b)

(** val minus : q -> q -> q **)

let minus a b =
  qred (qminus a b)

(** val times : q -> q -> q **)

let times a b =
  qred (qmult a b)

(** val below : q -> q -> bool **)

let below a b =
  negb (qle_bool b a)

type interval = { from_ : q; after_ : bool; to_ : (q * bool) option }

(** val with_head : q -> q list -> q list **)

let with_head a p = match p with
| [] -> if qeq_bool a { qnum = Z0; qden = XH } then [] else a :: []
| _ :: _ -> a :: p

(** val padd0 : q list -> q list -> q list **)

let rec padd0 p q0 =
  match p with
  | [] -> q0
  | a :: p2 ->
    (match q0 with
     | [] -> p
     | b :: q1 -> with_head (plus a b) (padd0 p2 q1))

(** val pscale : q -> q list -> q list **)

let pscale c p =
  if qeq_bool c { qnum = Z0; qden = XH } then [] else map (times c) p

(** val psub0 : q list -> q list -> q list **)

let psub0 p q0 =
  padd0 p (pscale { qnum = (Zneg XH); qden = XH } q0)

(** val pmul0 : q list -> q list -> q list **)

let rec pmul0 p q0 =
  match p with
  | [] -> []
  | a :: p2 ->
    (match p2 with
     | [] -> (match q0 with
              | [] -> []
              | _ :: _ -> pscale a q0)
     | _ :: _ ->
       (match q0 with
        | [] -> []
        | _ :: _ ->
          padd0 (pscale a q0) ({ qnum = Z0; qden = XH } :: (pmul0 p2 q0))))

(** val ppow : q list -> nat -> q list **)

let rec ppow p = function
| O -> { qnum = (Zpos XH); qden = XH } :: []
| S n1 -> pmul0 p (ppow p n1)

(** val pshift : q -> q list -> q list **)

let rec pshift c = function
| [] -> []
| a :: p2 ->
  padd0 (a :: [])
    (pmul0 (c :: ({ qnum = (Zpos XH); qden = XH } :: [])) (pshift c p2))

(** val fadd : q list -> q list -> q list **)

let rec fadd l m =
  match l with
  | [] -> []
  | a :: l0 -> (match m with
                | [] -> []
                | b :: m0 -> (plus a b) :: (fadd l0 m0))

(** val fscale : q -> q list -> q list **)

let fscale c l =
  map (times c) l

(** val ones : q -> nat -> q list **)

let rec ones w = function
| O -> { qnum = (Zpos XH); qden = XH } :: []
| S n1 ->
  let l = ones w n1 in
  fscale (qinv w)
    (fadd ({ qnum = Z0; qden = XH } :: l)
      (app l ({ qnum = Z0; qden = XH } :: [])))

(** val bernstein : q -> q list -> q list **)

let rec bernstein w = function
| [] -> []
| a :: p2 ->
  let l = bernstein w p2 in
  fadd (fscale a (ones w (length l))) ({ qnum = Z0; qden = XH } :: l)

(** val none_below_0 : q list -> bool **)

let none_below_0 l =
  forallb (qle_bool { qnum = Z0; qden = XH }) l

(** val one_above_0 : q list -> bool **)

let one_above_0 l =
  existsb (below { qnum = Z0; qden = XH }) l

(** val above0 : bool -> q list -> interval -> bool **)

let above0 strict p i =
  let p2 = pshift i.from_ p in
  (match i.to_ with
   | Some p3 ->
     let (b, before) = p3 in
     if qle_bool b i.from_
     then if strict
          then below { qnum = Z0; qden = XH } (hd { qnum = Z0; qden = XH } p2)
          else qle_bool { qnum = Z0; qden = XH }
                 (hd { qnum = Z0; qden = XH } p2)
     else let l = bernstein (minus b i.from_) p2 in
          (&&) (none_below_0 l)
            ((||) (negb strict)
              ((&&)
                ((&&) (one_above_0 l)
                  ((||) i.after_
                    (below { qnum = Z0; qden = XH }
                      (hd { qnum = Z0; qden = XH } l))))
                ((||) before
                  (below { qnum = Z0; qden = XH }
                    (last l { qnum = Z0; qden = XH })))))
   | None ->
     (&&) (none_below_0 p2)
       ((||) (negb strict)
         ((&&) (one_above_0 p2)
           ((||) i.after_
             (below { qnum = Z0; qden = XH } (hd { qnum = Z0; qden = XH } p2))))))

type course = { starts_at : q; starts_with : q; pieces : ((q * q) * q) list;
                finally : q }

type sort =
| Car
| Truck
| Bus
| Motorcycle
| Other

type body = { is_a : sort; long : q; wide : q; along : course; across : course }

type rectangle = { lane : char list; lies_in : zone; from_s : q option;
                   to_s : q option; right_d : q; left_d : q }

type drive = { bodies : (vehicle * body) list; first_rectangle : rectangle;
               other_rectangles : rectangle list;
               beside : (char list * char list) list;
               lanes_named : (char list * char list) list;
               values0 : (char list * q) list;
               signals : ((signal * vehicle) * ((q * q) * q) list) list;
               numbers : (char list * q) list; repeats : (q * q) option }

(** val look_up : char list -> (char list * 'a1) list -> 'a1 -> 'a1 **)

let look_up x l otherwise =
  match find (fun entry -> eqb0 x (fst entry)) l with
  | Some entry -> snd entry
  | None -> otherwise

(** val first_step : ((q * q) * q) list -> q **)

let first_step = function
| [] -> { qnum = Z0; qden = XH }
| p :: _ -> let (p2, _) = p in let (_, x) = p2 in x

(** val same_signal : signal -> signal -> bool **)

let same_signal m n0 =
  match m with
  | Place_lon -> (match n0 with
                  | Place_lon -> true
                  | _ -> false)
  | Place_lat -> (match n0 with
                  | Place_lat -> true
                  | _ -> false)
  | Speed_lon -> (match n0 with
                  | Speed_lon -> true
                  | _ -> false)
  | Speed_lat -> (match n0 with
                  | Speed_lat -> true
                  | _ -> false)
  | Acceleration_lon -> (match n0 with
                         | Acceleration_lon -> true
                         | _ -> false)
  | Acceleration_lat -> (match n0 with
                         | Acceleration_lat -> true
                         | _ -> false)
  | Jerk_lon -> (match n0 with
                 | Jerk_lon -> true
                 | _ -> false)
  | Own name ->
    (match n0 with
     | Own name0 -> string_dec name name0
     | _ -> false)

(** val still : course **)

let still =
  { starts_at = { qnum = Z0; qden = XH }; starts_with = { qnum = Z0; qden =
    XH }; pieces = []; finally = { qnum = Z0; qden = XH } }

(** val nobody : body **)

let nobody =
  { is_a = Other; long = { qnum = (Zpos XH); qden = XH }; wide = { qnum =
    (Zpos XH); qden = XH }; along = still; across = still }

(** val steps_of : drive -> signal -> vehicle -> ((q * q) * q) list option **)

let steps_of d n0 a =
  option_map snd
    (find (fun e ->
      if same_signal n0 (fst (fst e)) then eqb0 a (snd (fst e)) else false)
      d.signals)

(** val number_of_sort : sort -> q **)

let number_of_sort = function
| Car -> { qnum = (Zpos XH); qden = XH }
| Truck -> { qnum = (Zpos (XO XH)); qden = XH }
| Bus -> { qnum = (Zpos (XI XH)); qden = XH }
| Motorcycle -> { qnum = (Zpos (XO (XO XH))); qden = XH }
| Other -> { qnum = (Zpos (XI (XO XH))); qden = XH }

(** val rectangles : drive -> rectangle list **)

let rectangles d =
  d.first_rectangle :: d.other_rectangles

type element_of = nat

(** val first_element : drive -> element_of **)

let first_element _ =
  O

(** val element_number : drive -> nat -> element_of **)

let element_number d k =
  if bool_dec (Nat.ltb k (length (rectangles d))) true
  then k
  else first_element d

(** val first_of : char list -> rectangle list -> nat **)

let rec first_of x = function
| [] -> O
| r :: l0 -> if eqb0 r.lane x then O else S (first_of x l0)

(** val element_named : drive -> char list -> element_of **)

let element_named d x =
  element_number d (first_of (look_up x d.lanes_named []) (rectangles d))

type moment =
| Fixed of q
| Later of q

type derivation =
| Plain0
| Sign0 of q list
| Turn of derivation
| Both0 of derivation * derivation
| One of bool * derivation
| Split of q * bool * derivation * derivation
| Case of q list * derivation * derivation
| Element of nat * derivation
| Each of derivation list
| Whole of derivation
| Moment of moment * derivation
| Reach of moment * derivation * derivation
| Break of moment * derivation * derivation
| Soon of q * q * derivation * derivation
| Crossing of q * q * q list * derivation * derivation * derivation
| Earlier of nat * derivation
| Round of derivation

type shape = { of_place : q list; of_speed : q list;
               of_acceleration : q list; of_jerk : q list }

(** val cubic : q -> q -> q -> q -> q -> q list **)

let cubic k x v a j =
  pshift (qopp k) (with_head x (with_head v (with_head a (with_head j []))))

(** val shaped : q -> q -> q -> q -> q -> shape **)

let shaped k x v a j =
  { of_place =
    (cubic k x v (times { qnum = (Zpos XH); qden = (XO XH) } a)
      (times { qnum = (Zpos XH); qden = (XO (XI XH)) } j)); of_speed =
    (cubic k v a (times { qnum = (Zpos XH); qden = (XO XH) } j) { qnum = Z0;
      qden = XH }); of_acceleration =
    (cubic k a j { qnum = Z0; qden = XH } { qnum = Z0; qden = XH });
    of_jerk =
    (cubic k j { qnum = Z0; qden = XH } { qnum = Z0; qden = XH } { qnum = Z0;
      qden = XH }) }

(** val shapes :
    q -> q -> q -> ((q * q) * q) list -> q -> (q * shape) list **)

let rec shapes k x v ps last0 =
  match ps with
  | [] -> (k, (shaped k x v last0 { qnum = Z0; qden = XH })) :: []
  | p :: ps0 ->
    let (p2, j) = p in
    let (d, a) = p2 in
    let d2 = times d d in
    (k,
    (shaped k x v a j)) :: (shapes (plus k d)
                             (plus
                               (plus (plus x (times v d))
                                 (times { qnum = (Zpos XH); qden = (XO XH) }
                                   (times a d2)))
                               (times { qnum = (Zpos XH); qden = (XO (XI
                                 XH)) } (times j (times d d2))))
                             (plus (plus v (times a d))
                               (times { qnum = (Zpos XH); qden = (XO XH) }
                                 (times j d2))) ps0 last0)

(** val shapes_of : course -> (q * shape) list **)

let shapes_of c =
  shapes { qnum = Z0; qden = XH } c.starts_at c.starts_with c.pieces c.finally

(** val ends_by : interval -> q -> bool **)

let ends_by i c =
  match i.to_ with
  | Some p ->
    let (b, before) = p in if before then qle_bool b c else below b c
  | None -> false

(** val shape_on : (q * shape) list -> interval -> shape option **)

let rec shape_on l i =
  match l with
  | [] -> None
  | p2 :: rest ->
    let (_, p) = p2 in
    (match rest with
     | [] -> Some p
     | p3 :: _ ->
       let (k, _) = p3 in
       if ends_by i k
       then Some p
       else if qle_bool k i.from_ then shape_on rest i else None)

type shaped_body = { shaped_along : (q * shape) list;
                     shaped_across : (q * shape) list; long_ : q; wide_ : 
                     q; sort_ : sort }

(** val body_shaped : body -> shaped_body **)

let body_shaped b =
  { shaped_along = (shapes_of b.along); shaped_across = (shapes_of b.across);
    long_ = b.long; wide_ = b.wide; sort_ = b.is_a }

type fleet = (vehicle * shaped_body) list

(** val fleet_of : drive -> fleet **)

let fleet_of d =
  map (fun e -> ((fst e), (body_shaped (snd e)))) d.bodies

(** val only : interval -> q -> bool **)

let only i k =
  (&&) (qle_bool k i.from_)
    (match i.to_ with
     | Some p -> let (b, _) = p in qle_bool b k
     | None -> false)

(** val step_on : q -> ((q * q) * q) list -> interval -> q option **)

let rec step_on before steps i =
  match steps with
  | [] -> Some before
  | p :: rest ->
    let (p2, y) = p in
    let (k, x) = p2 in
    if ends_by i k
    then Some before
    else if only i k
         then Some x
         else if qle_bool k i.from_
              then (match step_on y rest i with
                    | Some z0 ->
                      if (||) ((||) (below k i.from_) i.after_)
                           (qeq_bool z0 x)
                      then Some z0
                      else None
                    | None -> None)
              else None

(** val shaped_of : fleet -> vehicle -> shaped_body **)

let shaped_of f a =
  look_up a f (body_shaped nobody)

(** val as_list : shape option -> (shape -> q list) -> q list list **)

let as_list p g =
  match p with
  | Some p2 -> (g p2) :: []
  | None -> []

(** val motion_on : fleet -> signal -> vehicle -> interval -> q list list **)

let motion_on f n0 a i =
  let b = shaped_of f a in
  (match n0 with
   | Place_lon -> as_list (shape_on b.shaped_along i) (fun s -> s.of_place)
   | Place_lat -> as_list (shape_on b.shaped_across i) (fun s -> s.of_place)
   | Speed_lon -> as_list (shape_on b.shaped_along i) (fun s -> s.of_speed)
   | Speed_lat -> as_list (shape_on b.shaped_across i) (fun s -> s.of_speed)
   | Acceleration_lon ->
     as_list (shape_on b.shaped_along i) (fun s -> s.of_acceleration)
   | Acceleration_lat ->
     as_list (shape_on b.shaped_across i) (fun s -> s.of_acceleration)
   | Jerk_lon -> as_list (shape_on b.shaped_along i) (fun s -> s.of_jerk)
   | Own _ -> [] :: [])

(** val in_first : drive -> interval -> bool **)

let in_first d i =
  match d.repeats with
  | Some p ->
    let (start, period) = p in
    (&&) (below { qnum = Z0; qden = XH } period)
      (ends_by i (plus start period))
  | None -> true

(** val signal_on :
    drive -> fleet -> signal -> vehicle -> interval -> q list list **)

let signal_on d f n0 a i =
  if in_first d i
  then (match steps_of d n0 a with
        | Some steps ->
          (match step_on (first_step steps) steps i with
           | Some x -> (x :: []) :: []
           | None -> [])
        | None -> motion_on f n0 a i)
  else []

(** val size_on : fleet -> size -> vehicle -> q **)

let size_on f n0 a =
  let b = shaped_of f a in
  (match n0 with
   | Length -> b.long_
   | Width -> b.wide_
   | Kind -> number_of_sort b.sort_)

(** val pairs_with :
    (q list -> q list -> q list list) -> q list list -> q list list -> q list
    list **)

let pairs_with g l m =
  flat_map (fun p -> flat_map (g p) m) l

(** val constant : q list -> q option **)

let constant = function
| [] -> Some { qnum = Z0; qden = XH }
| c :: l -> (match l with
             | [] -> Some c
             | _ :: _ -> None)

(** val larger : interval -> q list -> q list -> q list list **)

let larger i p q0 =
  if above0 false (psub0 p q0) i
  then p :: []
  else if above0 false (psub0 q0 p) i then q0 :: [] else p :: (q0 :: [])

(** val smaller : interval -> q list -> q list -> q list list **)

let smaller i p q0 =
  if above0 false (psub0 p q0) i
  then q0 :: []
  else if above0 false (psub0 q0 p) i then p :: [] else p :: (q0 :: [])

(** val divided : q list list -> q list list -> q list list **)

let divided l = function
| [] -> []
| q0 :: l0 ->
  (match l0 with
   | [] ->
     (match constant q0 with
      | Some c ->
        if qeq_bool c { qnum = Z0; qden = XH }
        then []
        else map (pscale (qred (qinv c))) l
      | None -> [])
   | _ :: _ -> [])

(** val term_on : drive -> fleet -> interval -> term -> q list list **)

let rec term_on d f i = function
| Num q0 -> (q0 :: []) :: []
| Par n0 -> ((look_up n0 d.values0 { qnum = Z0; qden = XH }) :: []) :: []
| Var x0 -> ((look_up x0 d.numbers { qnum = Z0; qden = XH }) :: []) :: []
| Sig (n0, a) -> signal_on d f n0 a i
| Siz (n0, a) -> ((size_on f n0 a) :: []) :: []
| Add (x0, y) ->
  pairs_with (fun p q0 -> (padd0 p q0) :: []) (term_on d f i x0)
    (term_on d f i y)
| Mul (x0, y) ->
  pairs_with (fun p q0 -> (pmul0 p q0) :: []) (term_on d f i x0)
    (term_on d f i y)
| Pow (x0, n0) -> map (fun p -> ppow p n0) (term_on d f i x0)
| Div (x0, y) -> divided (term_on d f i x0) (term_on d f i y)
| Max (x0, y) -> pairs_with (larger i) (term_on d f i x0) (term_on d f i y)
| Min (x0, y) -> pairs_with (smaller i) (term_on d f i x0) (term_on d f i y)

(** val rigid0 : drive -> fleet -> interval -> term -> q option **)

let rigid0 d f i x =
  match term_on d f i x with
  | [] -> None
  | p :: l -> (match l with
               | [] -> constant p
               | _ :: _ -> None)

(** val some_pair :
    (q list -> q list -> bool) -> q list list -> q list list -> bool **)

let some_pair f l m =
  match l with
  | [] -> false
  | _ :: _ ->
    (match m with
     | [] -> false
     | _ :: _ -> forallb (fun p -> forallb (f p) m) l)

(** val pneg : q list -> q list **)

let pneg p =
  pscale { qnum = (Zneg XH); qden = XH } p

(** val pone : q list **)

let pone =
  { qnum = (Zpos XH); qden = XH } :: []

(** val in_order :
    drive -> fleet -> bool -> side -> side -> interval -> bool **)

let in_order d f strict l r i =
  match l with
  | Fin x ->
    (match r with
     | Fin y ->
       some_pair (fun p q0 -> above0 strict (psub0 q0 p) i) (term_on d f i x)
         (term_on d f i y)
     | Inv y ->
       some_pair (fun p q0 ->
         (||)
           ((&&) (above0 false q0 i)
             (above0 strict (psub0 pone (pmul0 p q0)) i))
           ((&&) (above0 true (pneg q0) i)
             (above0 strict (psub0 (pmul0 p q0) pone) i))) (term_on d f i x)
         (term_on d f i y))
  | Inv x ->
    (match r with
     | Fin y ->
       some_pair (fun p q0 ->
         (||)
           ((&&) (above0 true p i)
             (above0 strict (psub0 (pmul0 p q0) pone) i))
           ((&&) (above0 true (pneg p) i)
             (above0 strict (psub0 pone (pmul0 p q0)) i))) (term_on d f i x)
         (term_on d f i y)
     | Inv y ->
       some_pair (fun p q0 ->
         (||)
           ((||) ((&&) (above0 false q0 i) (above0 strict (psub0 p q0) i))
             ((&&) (above0 true (pneg p) i) (above0 strict (psub0 p q0) i)))
           ((&&) (above0 true (pneg p) i) (above0 false q0 i)))
         (term_on d f i x) (term_on d f i y))

(** val compare_on :
    drive -> fleet -> bool -> comparison0 -> side -> side -> interval -> bool **)

let compare_on d f pol0 o l r i =
  match o with
  | LT -> if pol0 then in_order d f true l r i else in_order d f false r l i
  | LE -> if pol0 then in_order d f false l r i else in_order d f true r l i
  | GT -> if pol0 then in_order d f true r l i else in_order d f false l r i
  | GE -> if pol0 then in_order d f false r l i else in_order d f true l r i

(** val number_of : drive -> element -> nat **)

let number_of _ e =
  Obj.magic e

(** val at_number : drive -> nat -> rectangle **)

let at_number d e =
  nth e (rectangles d) d.first_rectangle

(** val count : drive -> nat **)

let count d =
  length (rectangles d)

(** val edges :
    drive -> fleet -> vehicle -> nat -> interval -> q list list option **)

let edges d f a e i =
  let r = at_number d e in
  (match signal_on d f Place_lon a i with
   | [] -> None
   | p :: l ->
     (match l with
      | [] ->
        (match signal_on d f Place_lat a i with
         | [] -> None
         | q0 :: l0 ->
           (match l0 with
            | [] ->
              Some
                (app
                  (match r.from_s with
                   | Some x -> (psub0 p (x :: [])) :: []
                   | None -> [])
                  (app
                    (match r.to_s with
                     | Some x ->
                       (psub0 (x :: [])
                         (psub0 p ((size_on f Length a) :: []))) :: []
                     | None -> [])
                    ((psub0 q0 (r.right_d :: [])) :: ((psub0 (r.left_d :: [])
                                                        (psub0 q0
                                                          ((size_on f Width a) :: []))) :: []))))
            | _ :: _ -> None))
      | _ :: _ -> None))

(** val occupies_on :
    drive -> fleet -> bool -> vehicle -> nat -> interval -> bool **)

let occupies_on d f pol0 a e i =
  match edges d f a e i with
  | Some ps ->
    if pol0
    then forallb (fun p -> above0 true p i) ps
    else existsb (fun p -> above0 false (pneg p) i) ps
  | None -> false

(** val index_of : drive -> (nat -> nat) -> road -> nat **)

let index_of d env = function
| Free x -> number_of d (Obj.magic element_named d x)
| Bound n0 -> env n0

(** val put0 : (nat -> nat) -> nat -> nat -> nat -> nat **)

let put0 env n0 e k =
  if Nat.eqb k n0 then e else env k

(** val same_zone : zone -> zone -> bool **)

let same_zone x y =
  match x with
  | Main -> (match y with
             | Main -> true
             | _ -> false)
  | Merge -> (match y with
              | Merge -> true
              | _ -> false)
  | Depart -> (match y with
               | Depart -> true
               | _ -> false)

(** val is_pair :
    char list -> char list -> (char list * char list) -> bool **)

let is_pair x y p =
  (&&) (eqb0 x (fst p)) (eqb0 y (snd p))

(** val is_member : drive -> (nat -> nat) -> domain -> nat -> bool **)

let is_member d env d0 e =
  let there = (at_number d e).lane in
  (match d0 with
   | Lanes -> true
   | Adjacent l ->
     let here = (at_number d (index_of d env l)).lane in
     (&&) (negb (eqb0 here there))
       (existsb (fun p -> (||) (is_pair here there p) (is_pair there here p))
         d.beside)
   | Lanelets l -> eqb0 (at_number d (index_of d env l)).lane there
   | Zone z0 -> same_zone (at_number d e).lies_in z0)

(** val members : drive -> (nat -> nat) -> domain -> nat list **)

let members d env d0 =
  filter (is_member d env d0) (seq O (count d))

(** val before_ : interval -> q -> bool -> interval **)

let before_ i c after =
  { from_ = i.from_; after_ = i.after_; to_ = (Some (c, (negb after))) }

(** val since : interval -> q -> bool -> interval **)

let since i c after =
  { from_ = c; after_ = after; to_ = i.to_ }

(** val parts : interval -> q list -> interval list **)

let rec parts i = function
| [] -> i :: []
| c :: cuts0 -> (before_ i c false) :: (parts (since i c false) cuts0)

(** val moved_by : q -> (q * bool) option -> (q * bool) option **)

let moved_by u to0 =
  option_map (fun b -> ((plus (fst b) u), (snd b))) to0

(** val image : interval -> moment -> interval **)

let image i = function
| Fixed u -> { from_ = u; after_ = false; to_ = (Some (u, false)) }
| Later u ->
  { from_ = (plus i.from_ u); after_ = i.after_; to_ = (moved_by u i.to_) }

(** val is_late : drive -> fleet -> interval -> moment -> term -> bool **)

let is_late d f i m lo =
  match rigid0 d f i lo with
  | Some a ->
    (match m with
     | Fixed u ->
       (match i.to_ with
        | Some p -> let (b, _) = p in qle_bool (plus b a) u
        | None -> false)
     | Later u -> qle_bool a u)
  | None -> false

(** val is_early :
    drive -> fleet -> interval -> moment -> term option -> bool **)

let is_early d f i m = function
| Some hi0 ->
  (match rigid0 d f i hi0 with
   | Some b ->
     (match m with
      | Fixed u -> qle_bool u (plus i.from_ b)
      | Later u -> qle_bool u b)
   | None -> false)
| None -> true

(** val meets :
    drive -> fleet -> interval -> moment -> term -> term option -> bool **)

let meets d f i m lo hi =
  (&&) (is_late d f i m lo) (is_early d f i m hi)

(** val widened :
    drive -> fleet -> interval -> term -> term option -> interval option **)

let widened d f i lo hi =
  match rigid0 d f i lo with
  | Some a ->
    (match hi with
     | Some hi0 ->
       option_map (fun b -> { from_ = (plus i.from_ a); after_ = i.after_;
         to_ = (moved_by b i.to_) }) (rigid0 d f i hi0)
     | None ->
       Some { from_ = (plus i.from_ a); after_ = i.after_; to_ = None })
  | None -> None

(** val until_then :
    drive -> fleet -> interval -> moment -> term -> bool -> interval option **)

let until_then d f i m lo out =
  option_map (fun a -> { from_ = (plus i.from_ a); after_ = i.after_; to_ =
    (match m with
     | Fixed u -> Some (u, out)
     | Later u ->
       option_map (fun b -> ((plus (fst b) u), ((||) out (snd b)))) i.to_) })
    (rigid0 d f i lo)

(** val at_once : drive -> fleet -> interval -> moment -> term -> bool **)

let at_once d f i m lo =
  match rigid0 d f i lo with
  | Some a ->
    (match m with
     | Fixed u -> qle_bool u (plus i.from_ a)
     | Later u -> qle_bool u a)
  | None -> false

(** val is_empty :
    drive -> fleet -> interval -> term -> term option -> bool **)

let is_empty d f i lo hi =
  match rigid0 d f i lo with
  | Some a ->
    (match hi with
     | Some hi0 ->
       (match rigid0 d f i hi0 with
        | Some b -> below b a
        | None -> false)
     | None -> false)
  | None -> false

(** val closed_ : q -> q -> interval **)

let closed_ a b =
  { from_ = a; after_ = false; to_ = (Some (b, false)) }

(** val open_ : q -> q -> interval **)

let open_ a b =
  { from_ = a; after_ = true; to_ = (Some (b, true)) }

(** val falls : q list -> q -> q -> bool **)

let falls s a b =
  (&&) ((&&) (below a b) (above0 true s (closed_ a a)))
    (above0 false (pneg s) (closed_ b b))

(** val same_sign : q list -> q list -> bool option **)

let same_sign s q0 =
  let c =
    qred
      (qdiv (last q0 { qnum = Z0; qden = XH })
        (last s { qnum = Z0; qden = XH }))
  in
  (match psub0 q0 (pscale c s) with
   | [] ->
     if below { qnum = Z0; qden = XH } c
     then Some true
     else if below c { qnum = Z0; qden = XH } then Some false else None
   | _ :: _ -> None)

(** val says_less : bool -> bool -> bool option **)

let says_less same0 above3 =
  if same0 then Some above3 else if above3 then Some false else None

(** val says_greater : bool -> bool -> bool option **)

let says_greater same0 above3 =
  if same0 then if above3 then Some false else None else Some above3

(** val said_of :
    drive -> fleet -> interval -> q list -> bool -> side -> comparison0 ->
    side -> bool option **)

let said_of d f i s above3 l o r =
  match l with
  | Fin x ->
    (match r with
     | Fin y ->
       (match term_on d f i x with
        | [] -> None
        | u :: l0 ->
          (match l0 with
           | [] ->
             (match term_on d f i y with
              | [] -> None
              | v :: l1 ->
                (match l1 with
                 | [] ->
                   (match same_sign s (psub0 v u) with
                    | Some same0 ->
                      (match o with
                       | LT -> says_less same0 above3
                       | LE -> option_map negb (says_greater same0 above3)
                       | GT -> says_greater same0 above3
                       | GE -> option_map negb (says_less same0 above3))
                    | None -> None)
                 | _ :: _ -> None))
           | _ :: _ -> None))
     | Inv _ -> None)
  | Inv _ -> None

(** val assume :
    drive -> fleet -> interval -> q list -> bool -> formula -> formula **)

let rec assume d f i s above3 f0 = match f0 with
| Compare (l, o, r) ->
  (match said_of d f i s above3 l o r with
   | Some b -> Truth b
   | None -> f0)
| Some_ (n0, d0, f1) -> Some_ (n0, d0, (assume d f i s above3 f1))
| Every (n0, d0, f1) -> Every (n0, d0, (assume d f i s above3 f1))
| Not f1 -> Not (assume d f i s above3 f1)
| And (f1, g) -> And ((assume d f i s above3 f1), (assume d f i s above3 g))
| Or (f1, g) -> Or ((assume d f i s above3 f1), (assume d f i s above3 g))
| _ -> f0

(** val at_zero :
    drive -> fleet -> interval -> q list -> formula -> formula **)

let at_zero d f i s f0 =
  assume d f i s false (assume d f i (pneg s) false f0)

(** val is_ahead : drive -> fleet -> q -> term -> bool **)

let is_ahead d f start lo =
  match rigid0 d f { from_ = start; after_ = false; to_ = None } lo with
  | Some a -> qle_bool { qnum = Z0; qden = XH } a
  | None -> false

(** val looks_ahead : drive -> fleet -> q -> formula -> bool **)

let rec looks_ahead d f start = function
| Some_ (_, _, f1) -> looks_ahead d f start f1
| Every (_, _, f1) -> looks_ahead d f start f1
| Not f1 -> looks_ahead d f start f1
| And (f1, g) -> (&&) (looks_ahead d f start f1) (looks_ahead d f start g)
| Or (f1, g) -> (&&) (looks_ahead d f start f1) (looks_ahead d f start g)
| Until (f1, lo, _, g) ->
  (&&) ((&&) (is_ahead d f start lo) (looks_ahead d f start f1))
    (looks_ahead d f start g)
| Eventually (lo, _, f1) ->
  (&&) (is_ahead d f start lo) (looks_ahead d f start f1)
| Always (lo, _, f1) ->
  (&&) (is_ahead d f start lo) (looks_ahead d f start f1)
| _ -> true

(** val rounds_of : drive -> fleet -> formula -> interval -> q option **)

let rounds_of d f f0 i =
  match d.repeats with
  | Some p ->
    let (start, period) = p in
    if (&&)
         ((&&) (below { qnum = Z0; qden = XH } period)
           (qle_bool start i.from_)) (looks_ahead d f start f0)
    then Some period
    else None
  | None -> None

(** val earlier : interval -> q -> interval **)

let earlier i by_ =
  { from_ = (minus i.from_ by_); after_ = i.after_; to_ =
    (moved_by (qopp by_) i.to_) }

(** val many : nat -> q -> q **)

let many n0 period =
  times (inject_Z (Z.of_nat n0)) period

(** val first_of_rounds : interval -> q -> interval **)

let first_of_rounds i period =
  { from_ = i.from_; after_ = false; to_ = (Some ((plus i.from_ period),
    true)) }

(** val somewhere_in : interval option -> (interval -> bool) -> bool **)

let somewhere_in j check2 =
  match j with
  | Some j0 -> check2 j0
  | None -> false

(** val check1 :
    drive -> fleet -> derivation -> formula -> (nat -> nat) -> bool ->
    interval -> bool **)

let rec check1 d f p f0 env pol0 i =
  let each =
    let rec each ps es n0 f1 =
      match ps with
      | [] -> (match es with
               | [] -> true
               | _ :: _ -> false)
      | p2 :: ps0 ->
        (match es with
         | [] -> false
         | e :: es0 ->
           (&&) (check1 d f p2 f1 (put0 env n0 e) pol0 i) (each ps0 es0 n0 f1))
    in each
  in
  (match p with
   | Plain0 ->
     (match f0 with
      | Truth b -> eqb b pol0
      | Until (_, lo, hi, _) -> (&&) (negb pol0) (is_empty d f i lo hi)
      | Eventually (lo, hi, _) -> (&&) (negb pol0) (is_empty d f i lo hi)
      | Always (lo, hi, _) -> (&&) pol0 (is_empty d f i lo hi)
      | _ -> false)
   | Sign0 cuts ->
     (match f0 with
      | Compare (l, o, r) ->
        forallb (compare_on d f pol0 o l r) (parts i cuts)
      | Occupies (a, l) ->
        forallb (occupies_on d f pol0 a (index_of d env l)) (parts i cuts)
      | _ -> false)
   | Turn p2 ->
     (match f0 with
      | Not f1 -> check1 d f p2 f1 env (negb pol0) i
      | _ -> false)
   | Both0 (p2, q0) ->
     (match f0 with
      | And (f1, g) ->
        (&&) ((&&) pol0 (check1 d f p2 f1 env pol0 i))
          (check1 d f q0 g env pol0 i)
      | Or (f1, g) ->
        (&&) ((&&) (negb pol0) (check1 d f p2 f1 env pol0 i))
          (check1 d f q0 g env pol0 i)
      | _ -> false)
   | One (second, p2) ->
     (match f0 with
      | And (f1, g) ->
        (&&) (negb pol0) (check1 d f p2 (if second then g else f1) env pol0 i)
      | Or (f1, g) ->
        (&&) pol0 (check1 d f p2 (if second then g else f1) env pol0 i)
      | _ -> false)
   | Split (c, after, p2, q0) ->
     (&&) (check1 d f p2 f0 env pol0 (before_ i c after))
       (check1 d f q0 f0 env pol0 (since i c after))
   | Case (s, p2, q0) ->
     (&&) (check1 d f p2 (assume d f i s true f0) env pol0 i)
       (check1 d f q0 (assume d f i s false f0) env pol0 i)
   | Element (e, p2) ->
     (match f0 with
      | Some_ (n0, d0, f1) ->
        (&&) ((&&) ((&&) pol0 (Nat.ltb e (count d))) (is_member d env d0 e))
          (check1 d f p2 f1 (put0 env n0 e) pol0 i)
      | Every (n0, d0, f1) ->
        (&&)
          ((&&) ((&&) (negb pol0) (Nat.ltb e (count d)))
            (is_member d env d0 e)) (check1 d f p2 f1 (put0 env n0 e) pol0 i)
      | _ -> false)
   | Each ps ->
     (match f0 with
      | Some_ (n0, d0, f1) ->
        (&&) (negb pol0) (each ps (members d env d0) n0 f1)
      | Every (n0, d0, f1) -> (&&) pol0 (each ps (members d env d0) n0 f1)
      | _ -> false)
   | Whole p2 ->
     (match f0 with
      | Until (_, lo, hi, g) ->
        (&&) (negb pol0)
          (somewhere_in (widened d f i lo hi) (check1 d f p2 g env pol0))
      | Eventually (lo, hi, f1) ->
        (&&) (negb pol0)
          (somewhere_in (widened d f i lo hi) (check1 d f p2 f1 env pol0))
      | Always (lo, hi, f1) ->
        (&&) pol0
          (somewhere_in (widened d f i lo hi) (check1 d f p2 f1 env pol0))
      | _ -> false)
   | Moment (m, p2) ->
     (match f0 with
      | Eventually (lo, hi, f1) ->
        (&&) ((&&) pol0 (meets d f i m lo hi))
          (check1 d f p2 f1 env pol0 (image i m))
      | Always (lo, hi, f1) ->
        (&&) ((&&) (negb pol0) (meets d f i m lo hi))
          (check1 d f p2 f1 env pol0 (image i m))
      | _ -> false)
   | Reach (m, p2, q0) ->
     (match f0 with
      | Until (f1, lo, hi, g) ->
        (&&)
          ((&&) ((&&) pol0 (meets d f i m lo hi))
            (check1 d f q0 g env pol0 (image i m)))
          ((||) (at_once d f i m lo)
            (somewhere_in (until_then d f i m lo true)
              (check1 d f p2 f1 env pol0)))
      | _ -> false)
   | Break (m, p2, q0) ->
     (match f0 with
      | Until (f1, lo, _, g) ->
        (&&)
          ((&&) ((&&) (negb pol0) (is_late d f i m lo))
            (check1 d f p2 f1 env pol0 (image i m)))
          (somewhere_in (until_then d f i m lo false)
            (check1 d f q0 g env pol0))
      | _ -> false)
   | Soon (c, d0, p2, q0) ->
     (match f0 with
      | Until (f1, lo, _, g) ->
        (&&)
          ((&&)
            ((&&) ((&&) (negb pol0) (below c d0))
              (is_late d f i (Fixed c) lo))
            (somewhere_in (until_then d f i (Fixed c) lo false)
              (check1 d f p2 g env pol0)))
          (check1 d f q0 f1 env pol0 (open_ c d0))
      | _ -> false)
   | Crossing (a, b, s, p2, q0, r) ->
     (match f0 with
      | Until (f1, lo, hi, g) ->
        (&&)
          ((&&) (is_late d f i (Fixed a) lo)
            (somewhere_in (until_then d f i (Fixed a) lo false)
              (check1 d f p2 (if pol0 then f1 else g) env pol0)))
          (if pol0
           then (&&)
                  ((&&) ((&&) (falls s a b) (is_early d f i (Fixed b) hi))
                    (check1 d f q0 (assume d f (closed_ a b) s true f1) env
                      pol0 (closed_ a b)))
                  (check1 d f r (at_zero d f (closed_ a b) s g) env pol0
                    (closed_ a b))
           else (&&)
                  ((&&) ((&&) (below a b) (above0 true s (closed_ b b)))
                    (check1 d f q0 (assume d f (closed_ a b) s false g) env
                      pol0 (closed_ a b)))
                  (check1 d f r (assume d f (closed_ a b) s true f1) env pol0
                    (closed_ a b)))
      | Eventually (lo, hi, f1) ->
        (&&)
          ((&&) ((&&) ((&&) pol0 (falls s a b)) (is_late d f i (Fixed a) lo))
            (is_early d f i (Fixed b) hi))
          (check1 d f r (at_zero d f (closed_ a b) s f1) env pol0
            (closed_ a b))
      | Always (lo, hi, f1) ->
        (&&)
          ((&&)
            ((&&) ((&&) (negb pol0) (falls s a b))
              (is_late d f i (Fixed a) lo)) (is_early d f i (Fixed b) hi))
          (check1 d f r (at_zero d f (closed_ a b) s f1) env pol0
            (closed_ a b))
      | _ -> false)
   | Earlier (n0, p2) ->
     (match d.repeats with
      | Some p3 ->
        let (_, period) = p3 in
        let j = earlier i (many n0 period) in
        (match rounds_of d f f0 j with
         | Some _ -> check1 d f p2 f0 env pol0 j
         | None -> false)
      | None -> false)
   | Round p2 ->
     (match rounds_of d f f0 i with
      | Some period -> check1 d f p2 f0 env pol0 (first_of_rounds i period)
      | None -> false))

(** val all_steps : (q -> bool) -> ((q * q) * q) list option -> bool **)

let all_steps ok = function
| Some l ->
  (&&) (ok (first_step l))
    (forallb (fun e -> (&&) (ok (snd (fst e))) (ok (snd e))) l)
| None -> ok { qnum = Z0; qden = XH }

(** val within_bound : drive -> bound -> bool **)

let within_bound d = function
| At_least_0 p ->
  qle_bool { qnum = Z0; qden = XH }
    (look_up p d.values0 { qnum = Z0; qden = XH })
| Above_0 p ->
  below { qnum = Z0; qden = XH }
    (look_up p d.values0 { qnum = Z0; qden = XH })
| Own_at_least (n0, a, low) ->
  all_steps (qle_bool low) (steps_of d (Own n0) a)
| Own_at_most (n0, a, high) ->
  all_steps (fun x -> qle_bool x high) (steps_of d (Own n0) a)

(** val now : interval **)

let now =
  { from_ = { qnum = Z0; qden = XH }; after_ = false; to_ = (Some ({ qnum =
    Z0; qden = XH }, false)) }

(** val accepts0 : drive -> bound list -> formula -> derivation -> bool **)

let accepts0 d bounds claim p =
  (&&) (forallb (within_bound d) bounds)
    (check1 d (fleet_of d) p claim (fun _ -> O) true now)

(** val rate_of : signal -> signal option **)

let rate_of = function
| Place_lon -> Some Speed_lon
| Place_lat -> Some Speed_lat
| Speed_lon -> Some Acceleration_lon
| Speed_lat -> Some Acceleration_lat
| _ -> None

(** val known0 : term -> q option **)

let known0 = function
| Num q0 -> Some q0
| _ -> None

(** val add0 : term -> term -> term **)

let add0 x y =
  match known0 x with
  | Some p ->
    (match known0 y with
     | Some q0 -> Num (qred (qplus p q0))
     | None -> if qeq_bool p { qnum = Z0; qden = XH } then y else Add (x, y))
  | None ->
    (match known0 y with
     | Some q0 ->
       if qeq_bool q0 { qnum = Z0; qden = XH } then x else Add (x, y)
     | None -> Add (x, y))

(** val mul0 : term -> term -> term **)

let mul0 x y =
  match known0 x with
  | Some p ->
    (match known0 y with
     | Some q0 -> Num (qred (qmult p q0))
     | None ->
       if qeq_bool p { qnum = Z0; qden = XH }
       then Num { qnum = Z0; qden = XH }
       else Mul (x, y))
  | None ->
    (match known0 y with
     | Some q0 ->
       if qeq_bool q0 { qnum = Z0; qden = XH }
       then Num { qnum = Z0; qden = XH }
       else Mul (x, y)
     | None -> Mul (x, y))

(** val power : q -> nat -> q **)

let rec power p = function
| O -> { qnum = (Zpos XH); qden = XH }
| S n1 -> qred (qmult p (power p n1))

(** val pow_ : term -> nat -> term **)

let pow_ x n0 =
  match known0 x with
  | Some p -> Num (power p n0)
  | None -> Pow (x, n0)

(** val div : term -> term -> term **)

let div x y =
  match known0 x with
  | Some p ->
    (match known0 y with
     | Some q0 ->
       if qeq_bool q0 { qnum = Z0; qden = XH }
       then Div (x, y)
       else Num (qred (qdiv p q0))
     | None -> Div (x, y))
  | None -> Div (x, y)

(** val max_ : term -> term -> term **)

let max_ x y =
  match known0 x with
  | Some p ->
    (match known0 y with
     | Some q0 -> if qle_bool p q0 then y else x
     | None -> Max (x, y))
  | None -> Max (x, y)

(** val min_ : term -> term -> term **)

let min_ x y =
  match known0 x with
  | Some p ->
    (match known0 y with
     | Some q0 -> if qle_bool p q0 then x else y
     | None -> Min (x, y))
  | None -> Min (x, y)

(** val simple : term -> term **)

let rec simple x = match x with
| Num q0 -> Num (qred q0)
| Add (x0, y) -> add0 (simple x0) (simple y)
| Mul (x0, y) -> mul0 (simple x0) (simple y)
| Pow (x0, n0) -> pow_ (simple x0) n0
| Div (x0, y) -> div (simple x0) (simple y)
| Max (x0, y) -> max_ (simple x0) (simple y)
| Min (x0, y) -> min_ (simple x0) (simple y)
| _ -> x

(** val simple_side : side -> side **)

let simple_side = function
| Fin x -> Fin (simple x)
| Inv x -> Inv (simple x)

(** val not_ : formula -> formula **)

let not_ f = match f with
| Truth b -> Truth (negb b)
| Not g -> g
| _ -> Not f

(** val and_ : formula -> formula -> formula **)

let and_ f g =
  match f with
  | Truth b ->
    if b
    then g
    else (match g with
          | Truth b0 -> if b0 then f else Truth false
          | _ -> Truth false)
  | _ ->
    (match g with
     | Truth b -> if b then f else Truth false
     | _ -> And (f, g))

(** val or_ : formula -> formula -> formula **)

let or_ f g =
  match f with
  | Truth b ->
    if b
    then (match g with
          | Truth b0 -> if b0 then Truth true else f
          | _ -> Truth true)
    else g
  | _ ->
    (match g with
     | Truth b -> if b then Truth true else f
     | _ -> Or (f, g))

(** val plain0 : formula -> formula **)

let rec plain0 f = match f with
| Compare (l, o, r) -> Compare ((simple_side l), o, (simple_side r))
| Some_ (n0, d, f0) -> Some_ (n0, d, (plain0 f0))
| Every (n0, d, f0) -> Every (n0, d, (plain0 f0))
| Not f0 -> not_ (plain0 f0)
| And (f0, g) -> and_ (plain0 f0) (plain0 g)
| Or (f0, g) -> or_ (plain0 f0) (plain0 g)
| Until (f0, lo, hi, g) ->
  Until ((plain0 f0), (simple lo), (option_map simple hi), (plain0 g))
| Eventually (lo, hi, f0) ->
  Eventually ((simple lo), (option_map simple hi), (plain0 f0))
| Always (lo, hi, f0) ->
  Always ((simple lo), (option_map simple hi), (plain0 f0))
| _ -> f

(** val rate : term -> term option **)

let rec rate x =
  if term_rigid x
  then Some (Num { qnum = Z0; qden = XH })
  else (match x with
        | Sig (n0, a) -> option_map (fun r -> Sig (r, a)) (rate_of n0)
        | Add (x0, y) ->
          (match rate x0 with
           | Some x1 ->
             (match rate y with
              | Some y0 -> Some (Add (x1, y0))
              | None -> None)
           | None -> None)
        | Mul (x0, y) ->
          if term_rigid x0
          then option_map (fun x1 -> Mul (x0, x1)) (rate y)
          else if term_rigid y
               then option_map (fun x1 -> Mul (x1, y)) (rate x0)
               else None
        | Div (x0, y) ->
          if term_rigid y
          then option_map (fun x1 -> Div (x1, y)) (rate x0)
          else None
        | _ -> None)

(** val continuous : term -> bool **)

let rec continuous = function
| Sig (n0, _) -> (match rate_of n0 with
                  | Some _ -> true
                  | None -> false)
| Add (x0, y) -> (&&) (continuous x0) (continuous y)
| Mul (x0, y) -> (&&) (continuous x0) (continuous y)
| Pow (x0, _) -> continuous x0
| Div (x0, y) -> (&&) (continuous x0) (term_rigid y)
| Max (x0, y) -> (&&) (continuous x0) (continuous y)
| Min (x0, y) -> (&&) (continuous x0) (continuous y)
| _ -> true

(** val is_open : bool -> formula -> bool **)

let rec is_open positive0 = function
| Truth _ -> true
| Compare (l, o, r) ->
  (match l with
   | Fin x ->
     (match o with
      | LT ->
        (match r with
         | Fin y -> (&&) ((&&) positive0 (continuous x)) (continuous y)
         | Inv _ -> false)
      | GT ->
        (match r with
         | Fin y -> (&&) ((&&) positive0 (continuous x)) (continuous y)
         | Inv _ -> false)
      | _ ->
        (match r with
         | Fin y -> (&&) ((&&) (negb positive0) (continuous x)) (continuous y)
         | Inv _ -> false))
   | Inv _ -> false)
| Occupies (_, _) -> positive0
| Some_ (_, _, f0) -> is_open positive0 f0
| Every (_, _, f0) -> is_open positive0 f0
| Not f0 -> is_open (negb positive0) f0
| And (f0, g) -> (&&) (is_open positive0 f0) (is_open positive0 g)
| Or (f0, g) -> (&&) (is_open positive0 f0) (is_open positive0 g)
| _ -> false

type schema =
| At_most of term * term
| Below of term * term
| Meets of term * term
| Leaves of formula
| Within of term * term * term * term
| After of term * term * term * term
| Within_twice of term * term * term * term * term
| After_twice of term * term * term * term * term
| Repeats of formula * term * term
| Lasts of formula * term

(** val is_induction : schema -> bool **)

let is_induction = function
| Repeats (_, _, _) -> true
| Lasts (_, _) -> true
| _ -> false

(** val always : formula -> formula **)

let always p =
  Always ((Num { qnum = Z0; qden = XH }), None, p)

(** val until : formula -> formula -> formula **)

let until p q0 =
  Until (p, (Num { qnum = Z0; qden = XH }), None, q0)

(** val implies : formula -> formula -> formula **)

let implies p q0 =
  Or ((Not p), q0)

(** val le : term -> term -> formula **)

let le x y =
  Compare ((Fin x), LE, (Fin y))

(** val lt : term -> term -> formula **)

let lt x y =
  Compare ((Fin x), LT, (Fin y))

(** val ge : term -> term -> formula **)

let ge x y =
  Compare ((Fin x), GE, (Fin y))

(** val half_square : term -> term -> term **)

let half_square growth time =
  Mul ((Mul ((Mul (growth, time)), time)), (Num { qnum = (Zpos XH); qden =
    (XO XH) }))

(** val above1 : term -> bool **)

let above1 x =
  match simple x with
  | Num p ->
    (&&) (qle_bool { qnum = Z0; qden = XH } p)
      (negb (qeq_bool p { qnum = Z0; qden = XH }))
  | _ -> false

(** val never_below : bound list -> term -> bool **)

let rec never_below bounds = function
| Num p -> qle_bool { qnum = Z0; qden = XH } p
| Par p ->
  existsb (fun b ->
    match b with
    | At_least_0 q0 -> eqb0 p q0
    | Above_0 q0 -> eqb0 p q0
    | _ -> false) bounds
| Siz (_, _) -> true
| Add (x0, y) -> (&&) (never_below bounds x0) (never_below bounds y)
| Mul (x0, y) -> (&&) (never_below bounds x0) (never_below bounds y)
| Pow (x0, _) -> never_below bounds x0
| Div (x0, y) -> (&&) (never_below bounds x0) (never_below bounds y)
| Max (x0, y) -> (&&) (never_below bounds x0) (never_below bounds y)
| Min (x0, y) -> (&&) (never_below bounds x0) (never_below bounds y)
| _ -> false

(** val where_ : bool -> formula -> formula option **)

let where_ b f =
  if b then Some f else None

(** val with_rates :
    term -> term -> (term -> term -> formula option) -> formula option **)

let with_rates x y f =
  match rate x with
  | Some x' -> (match rate y with
                | Some y' -> f x' y'
                | None -> None)
  | None -> None

(** val says : bound list -> schema -> formula option **)

let says bounds = function
| At_most (x, y) ->
  with_rates x y (fun x' y' -> Some
    (always
      (implies (le x y) (Not
        (until (Or ((le x y), (le x' y'))) (Not (le x y)))))))
| Below (x, y) ->
  with_rates x y (fun x' y' -> Some
    (always (implies (lt x y) (Not (until (le x' y') (Not (lt x y)))))))
| Meets (x, y) ->
  where_ ((&&) (continuous x) (continuous y))
    (always
      (implies (lt x y) (Or ((always (lt x y)),
        (until (lt x y) (And ((le x y), (ge x y))))))))
| Leaves p ->
  where_ (is_open true p)
    (always (implies p (Or ((always p), (until p (Not p))))))
| Within (x, y, r, d) ->
  with_rates x y (fun x' y' ->
    where_ ((&&) (term_rigid r) (term_rigid d))
      (always
        (implies (le x y) (Not (Until ((le x' (Add (y', r))), (Num { qnum =
          Z0; qden = XH }), (Some d), (Not
          (le x (Add (y, (Mul ((Max ((Num { qnum = Z0; qden = XH }), r)),
            d))))))))))))
| After (x, y, r, d) ->
  with_rates x y (fun x' y' ->
    where_ ((&&) ((&&) (term_rigid r) (term_rigid d)) (never_below bounds d))
      (always
        (implies (And ((le x y), (Always ((Num { qnum = Z0; qden = XH }),
          (Some d), (le x' (Add (y', r))))))) (Always (d, (Some d),
          (le x (Add (y, (Mul (r, d))))))))))
| Within_twice (x, y, v, r, d) ->
  with_rates x y (fun x' y' ->
    with_rates x' y' (fun x'' y'' ->
      where_ ((&&) ((&&) (term_rigid v) (term_rigid r)) (term_rigid d))
        (always
          (implies (And ((le x y), (le x' (Add (y', v))))) (Not (Until
            ((le x'' (Add (y'', r))), (Num { qnum = Z0; qden = XH }), (Some
            d), (Not
            (le x (Add (y, (Add ((Mul ((Max ((Num { qnum = Z0; qden = XH }),
              v)), d)),
              (half_square (Max ((Num { qnum = Z0; qden = XH }), r)) d))))))))))))))
| After_twice (x, y, v, r, d) ->
  with_rates x y (fun x' y' ->
    with_rates x' y' (fun x'' y'' ->
      where_
        ((&&) ((&&) ((&&) (term_rigid v) (term_rigid r)) (term_rigid d))
          (never_below bounds d))
        (always
          (implies (And ((And ((le x y), (le x' (Add (y', v))))), (Always
            ((Num { qnum = Z0; qden = XH }), (Some d),
            (le x'' (Add (y'', r))))))) (Always (d, (Some d),
            (le x (Add (y, (Add ((Mul (v, d)), (half_square r d))))))))))))
| Repeats (p, lo, hi) ->
  where_ ((&&) (above1 lo) (term_rigid hi))
    (always
      (implies (And (p,
        (always (implies p (Eventually (lo, (Some hi), p))))))
        (always (Eventually ((Num { qnum = Z0; qden = XH }), (Some hi), p)))))
| Lasts (p, d) ->
  where_ (above1 d)
    (always
      (implies (And (p,
        (always
          (implies p (Always ((Num { qnum = Z0; qden = XH }), (Some d), p))))))
        (always p)))

(** val conjuncts : formula -> formula list **)

let rec conjuncts f = match f with
| And (f0, g) -> app (conjuncts f0) (conjuncts g)
| _ -> f :: []

(** val parted : formula -> formula * formula **)

let parted f = match f with
| Not p -> (p, (Truth false))
| Or (f0, q0) -> (match f0 with
                  | Not p -> (p, q0)
                  | _ -> ((Truth true), f))
| _ -> ((Truth true), f)

(** val is_instance : bound list -> schema list -> formula -> bool **)

let is_instance bounds schemas f =
  existsb (fun s ->
    match says bounds s with
    | Some g -> same (plain0 g) (plain0 f)
    | None -> false) schemas

(** val adds : bound list -> schema list -> formula -> formula -> bool **)

let adds bounds schemas supposed claim =
  let (p, q0) = parted supposed in
  let fact2 = is_instance bounds schemas in
  (||) ((&&) (same q0 claim) (forallb fact2 (conjuncts p)))
    (let (p', q') = parted claim in
     (&&) (same q0 q')
       (forallb (fun f -> (||) (existsb (same f) (conjuncts p')) (fact2 f))
         (conjuncts p)))

module PositiveMap =
 struct
  type key = positive

  type 'a tree =
  | Leaf
  | Node of 'a tree * 'a option * 'a tree

  type 'a t = 'a tree

  (** val empty : 'a1 t **)

  let empty =
    Leaf

  (** val find : key -> 'a1 t -> 'a1 option **)

  let rec find i = function
  | Leaf -> None
  | Node (l, o, r) ->
    (match i with
     | XI ii -> find ii r
     | XO ii -> find ii l
     | XH -> o)

  (** val mem : key -> 'a1 t -> bool **)

  let rec mem i = function
  | Leaf -> false
  | Node (l, o, r) ->
    (match i with
     | XI ii -> mem ii r
     | XO ii -> mem ii l
     | XH -> (match o with
              | Some _ -> true
              | None -> false))

  (** val add : key -> 'a1 -> 'a1 t -> 'a1 t **)

  let rec add i v = function
  | Leaf ->
    (match i with
     | XI ii -> Node (Leaf, None, (add ii v Leaf))
     | XO ii -> Node ((add ii v Leaf), None, Leaf)
     | XH -> Node (Leaf, (Some v), Leaf))
  | Node (l, o, r) ->
    (match i with
     | XI ii -> Node (l, o, (add ii v r))
     | XO ii -> Node ((add ii v l), o, r)
     | XH -> Node (l, (Some v), r))
 end

type linear0 = (positive * z) list * z

type node =
| Holds of bool * linear0
| Every0 of positive list
| Either0 of positive list

type program = { scale : z; columns : (positive * (z * z)) list;
                 products : (positive * (positive * positive)) list;
                 equal : (positive * linear0) list;
                 above2 : (positive * linear0) list;
                 nodes : (positive * node) list; condition : positive }

(** val table0 : (positive * 'a1) list -> 'a1 PositiveMap.t **)

let rec table0 = function
| [] -> PositiveMap.empty
| p :: l0 -> let (k, a) = p in PositiveMap.add k a (table0 l0)

(** val distinct : (positive * 'a1) list -> bool **)

let rec distinct = function
| [] -> true
| p :: l0 ->
  let (k, _) = p in (&&) (negb (PositiveMap.mem k (table0 l0))) (distinct l0)

(** val merge :
    (positive * z) list -> (positive * z) list -> (positive * z) list **)

let rec merge u =
  let rec into v =
    match u with
    | [] -> v
    | p :: u' ->
      let (i, a) = p in
      (match v with
       | [] -> u
       | p2 :: v' ->
         let (j, b) = p2 in
         (match Coq_Pos.compare i j with
          | Eq -> (i, (Z.add a b)) :: (merge u' v')
          | Lt -> (i, a) :: (merge u' v)
          | Gt -> (j, b) :: (into v')))
  in into

(** val times0 : z -> (positive * z) list -> (positive * z) list **)

let times0 w u =
  map (fun e -> ((fst e), (Z.mul w (snd e)))) u

type fact1 =
| Equal0 of positive
| Above of positive
| Known of positive
| Corner of positive * bool * bool
| Tangent of positive * z

type tree0 =
| Sum of (fact1 * z) list
| Cases of positive * trees
| Cut0 of positive * z * tree0 * tree0
and trees =
| Done
| More of tree0 * trees

type tables = { size0 : z; product_of : (positive * positive) PositiveMap.t;
                equals : linear0 PositiveMap.t;
                aboves : linear0 PositiveMap.t; node_of : node PositiveMap.t }

type state = { box : (z * z) PositiveMap.t; known1 : unit PositiveMap.t }

(** val pick : bool -> (z * z) -> z **)

let pick b ends =
  if b then snd ends else fst ends

(** val corner :
    tables -> positive -> positive -> positive -> z -> z -> linear0 **)

let corner t0 k i j a b =
  let d = t0.size0 in
  ((merge
     (merge ((i, (Z.mul (Z.opp d) b)) :: []) ((j, (Z.mul (Z.opp d) a)) :: []))
     ((k, (Z.mul d d)) :: [])), (Z.mul a b))

(** val says0 :
    tables -> state -> fact1 -> ((bool * bool) * linear0) option **)

let says0 t0 s = function
| Equal0 n0 ->
  (match PositiveMap.find n0 t0.equals with
   | Some l -> Some ((true, false), l)
   | None -> None)
| Above n0 ->
  (match PositiveMap.find n0 t0.aboves with
   | Some l -> Some ((false, false), l)
   | None -> None)
| Known n0 ->
  (match PositiveMap.find n0 s.known1 with
   | Some _ ->
     (match PositiveMap.find n0 t0.node_of with
      | Some n1 ->
        (match n1 with
         | Holds (strict, l) -> Some ((false, strict), l)
         | _ -> None)
      | None -> None)
   | None -> None)
| Corner (k, first, second) ->
  (match PositiveMap.find k t0.product_of with
   | Some p ->
     let (i, j) = p in
     (match PositiveMap.find i s.box with
      | Some one ->
        (match PositiveMap.find j s.box with
         | Some other ->
           let l = corner t0 k i j (pick first one) (pick second other) in
           Some ((false, false),
           (if eqb first second
            then l
            else ((times0 (Zneg XH) (fst l)), (Z.opp (snd l)))))
         | None -> None)
      | None -> None)
   | None -> None)
| Tangent (k, a) ->
  (match PositiveMap.find k t0.product_of with
   | Some p ->
     let (i, j) = p in
     if Coq_Pos.eqb i j
     then Some ((false, false), (corner t0 k i j a a))
     else None
   | None -> None)

(** val total :
    tables -> state -> (fact1 * z) list -> (bool * linear0) option **)

let rec total t0 s = function
| [] -> Some (false, ([], Z0))
| p :: weights0 ->
  let (f, w) = p in
  (match says0 t0 s f with
   | Some p2 ->
     let (p3, l) = p2 in
     let (equation, strict) = p3 in
     (match total t0 s weights0 with
      | Some p4 ->
        let (strict', l') = p4 in
        if (||) equation (Z.leb Z0 w)
        then Some (((||) ((&&) strict (Z.ltb Z0 w)) strict'),
               ((merge (times0 w (fst l)) (fst l')),
               (Z.add (Z.mul w (snd l)) (snd l'))))
        else None
      | None -> None)
   | None -> None)

(** val greatest : tables -> state -> positive -> z -> z option **)

let greatest t0 s k c =
  match PositiveMap.find k t0.product_of with
  | Some p ->
    let (i, j) = p in
    (match PositiveMap.find i s.box with
     | Some p2 ->
       let (a, b) = p2 in
       (match PositiveMap.find j s.box with
        | Some p3 ->
          let (a', b') = p3 in
          Some
          (Z.max (Z.max (Z.mul c (Z.mul a a')) (Z.mul c (Z.mul a b')))
            (Z.max (Z.mul c (Z.mul b a')) (Z.mul c (Z.mul b b'))))
        | None -> None)
     | None -> None)
  | None ->
    (match PositiveMap.find k s.box with
     | Some p ->
       let (a, b) = p in Some (Z.mul t0.size0 (Z.max (Z.mul c a) (Z.mul c b)))
     | None -> None)

(** val most : tables -> state -> (positive * z) list -> z option **)

let rec most t0 s = function
| [] -> Some Z0
| p :: terms0 ->
  let (k, c) = p in
  (match greatest t0 s k c with
   | Some a ->
     (match most t0 s terms0 with
      | Some b -> Some (Z.add a b)
      | None -> None)
   | None -> None)

(** val absurd_sum : tables -> state -> (fact1 * z) list -> bool **)

let absurd_sum t0 s weights =
  match total t0 s weights with
  | Some p ->
    let (strict, l) = p in
    (match most t0 s (fst l) with
     | Some a ->
       let q0 = Z.add (Z.mul (snd l) (Z.mul t0.size0 t0.size0)) a in
       (||) (Z.ltb q0 Z0) ((&&) strict (Z.leb q0 Z0))
     | None -> false)
  | None -> false

(** val learn :
    tables -> nat -> unit PositiveMap.t -> positive -> unit PositiveMap.t **)

let rec learn t0 fuel k n0 =
  let k0 = PositiveMap.add n0 () k in
  (match fuel with
   | O -> k0
   | S fuel0 ->
     (match PositiveMap.find n0 t0.node_of with
      | Some n1 ->
        (match n1 with
         | Every0 parts0 -> fold_left (learn t0 fuel0) parts0 k0
         | _ -> k0)
      | None -> k0))

(** val dEPTH : nat **)

let dEPTH =
  S (S (S (S (S (S O)))))

(** val also : tables -> state -> positive -> state **)

let also t0 s n0 =
  { box = s.box; known1 = (learn t0 dEPTH s.known1 n0) }

(** val within : state -> positive -> (z * z) -> state **)

let within s k ends =
  { box = (PositiveMap.add k ends s.box); known1 = s.known1 }

(** val refutes0 : tables -> state -> tree0 -> bool **)

let refutes0 t0 =
  let rec refutes1 s = function
  | Sum weights -> absurd_sum t0 s weights
  | Cases (n0, each) ->
    (match PositiveMap.find n0 s.known1 with
     | Some _ ->
       (match PositiveMap.find n0 t0.node_of with
        | Some n1 ->
          (match n1 with
           | Either0 parts0 -> refutes_all s parts0 each
           | _ -> false)
        | None -> false)
     | None -> false)
  | Cut0 (k, a, low, high) ->
    (match PositiveMap.find k s.box with
     | Some p ->
       let (l, h) = p in
       (&&) (refutes1 (within s k (l, a)) low)
         (refutes1 (within s k (a, h)) high)
     | None -> false)
  and refutes_all s parts0 each =
    match parts0 with
    | [] -> (match each with
             | Done -> true
             | More (_, _) -> false)
    | p :: parts1 ->
      (match each with
       | Done -> false
       | More (t1, each0) ->
         (&&) (refutes1 (also t0 s p) t1) (refutes_all s parts1 each0))
  in refutes1

(** val tables_of : program -> tables **)

let tables_of p =
  { size0 = p.scale; product_of = (table0 p.products); equals =
    (table0 p.equal); aboves = (table0 p.above2); node_of = (table0 p.nodes) }

(** val begin0 : program -> state **)

let begin0 p =
  also (tables_of p) { box = (table0 p.columns); known1 = PositiveMap.empty }
    p.condition

(** val checks : program -> tree0 -> bool **)

let checks p t0 =
  (&&) ((&&) (Z.ltb Z0 p.scale) (distinct p.nodes))
    (refutes0 (tables_of p) (begin0 p) t0)

(** val accepts_proof :
    char list list -> bound list -> formula list -> values -> formula -> tree
    -> bool **)

let accepts_proof =
  accepts_at

(** val settles_fact :
    bound list -> term list -> formula -> reason -> bool **)

let settles_fact =
  settles

(** val is_known_fact : bound list -> formula -> bool **)

let is_known_fact =
  is_known

(** val accepts_drive :
    drive -> bound list -> formula -> derivation -> bool **)

let accepts_drive =
  accepts0

(** val adds_instances :
    bound list -> schema list -> formula -> formula -> bool **)

let adds_instances =
  adds

(** val refutes_program : program -> tree0 -> bool **)

let refutes_program =
  checks

(** val are_inductions : schema list -> bool **)

let are_inductions =
  forallb is_induction
