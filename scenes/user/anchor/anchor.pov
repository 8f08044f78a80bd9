// This work is licensed under the BSD 3-Clause License (SPDX-License-Identifier: BSD-3-Clause).
//
//    Persistence of Vision Ray Tracer version 3.7 Scene File
//    File: anchor.pov
//    Description: A lost anchor with its chain on rippled sand. One arm and one end of the stock have
//                 dug in; all else stands off the sand and casts four shadows, one a strobe.
//
//    aphotic render scenes/user/anchor/anchor.toml --antialias 2 -o out/anchor
//
//    A quick look, from this folder:
//
//    povray +L../../../plugin/include +Ianchor.pov +W680 +H512 +A0.3
//
// World: y up, metres; x to the right of the picture, z to its top; the sand at about y = 0.

#version 3.7;

#include "functions.inc"
#include "transforms.inc"
#declare Aphotic_Soft_Edge = 4;       // as a lens and its diffuser soften a beam's edge
#include "aphotic.inc"
#include "anchor_parts.inc"

#declare Aphotic_Sled = Aphotic_Place_Trans (<0, 1.7, 0>, <0, 0, 0>, z)
Aphotic_Rig ()

#declare Matt = finish { Aphotic_Finish (0, 40) }
#declare Iron = finish { Aphotic_Finish (0.12, 25) }

// --- Where the anchor lies ----------------------------------------------------------------------

#declare Anchor_Trans = transform {
   rotate 29 * z                      // on one arm and one end of the stock
   rotate -3 * x
   rotate 52 * y
   translate <-0.325, 0.112, -0.225>
}
#declare Buried_Arm = vtransform(<-0.26, 0, 0.16>, Anchor_Trans);
#declare Buried_Stock = vtransform(<0, -0.25, 0.86 * Anchor_Length>, Anchor_Trans);
#declare Ring = vtransform((Anchor_Length + 0.06) * z, Anchor_Trans);

// --- Sand: ripples, a hollow under the shank, heaps where the iron went in ----------------------

#declare Wander = function (x, z) { f_noise3d(2.6 * x, 5, 2.6 * z) }
#declare Phase = function (x, z) { 2 * pi / 0.082 * (z * 0.55 + x * 0.83 + 0.22 * Wander(x, z)) }
#declare Crest = function (x, z) { 1 - abs(sin(0.5 * Phase(x, z))) }
#declare Arm_X = Buried_Arm.x;         // functions take numbers alone
#declare Arm_Z = Buried_Arm.z;
#declare Stock_X = Buried_Stock.x;
#declare Stock_Z = Buried_Stock.z;
#declare Heap = function (x, z, R) { exp(-(x * x + z * z) / (R * R)) }
#declare Calm = function (x, z) {
   1 - 0.8 * min(1, Heap(x - Arm_X, z - Arm_Z, 0.13) + Heap(x - Stock_X, z - Stock_Z, 0.10))
}
#declare Sand_Height = function (x, z) {
   0.017 * pow(Crest(x, z), 1.25) * (0.40 + f_noise3d(2 * x, 1, 2 * z)) * Calm(x, z)
   + 0.03 * f_noise3d(2.5 * x, 9, 2.5 * z)
   + 0.030 * Heap(x - Arm_X, z - Arm_Z, 0.09)
   + 0.022 * Heap(x - Stock_X, z - Stock_Z, 0.07)
   + 0.0020 * f_noise3d(90 * x, 2, 90 * z)
}
#declare Width = 1.56;
#declare Depth = 1.20;
#declare Sand_Top = 0.10;
#declare Sand = height_field {
   function 860, 660 { Sand_Height((x - 0.5) * Width, (0.5 - y) * Depth) / Sand_Top }
   smooth
   translate <-0.5, 0, -0.5>
   scale <Width, Sand_Top, Depth>
}
#declare Grains = pigment {
   granite scale 0.009
   pigment_map {
      [0.10 Aphotic_Pigment ("brown-algae")]
      [0.26 Aphotic_Pigment ("rust-dark.csv")]
      [0.33 Aphotic_Pigment ("rust-orange.csv")]
      [0.44 Aphotic_Pigment ("sand")]
      [0.85 Aphotic_Pigment ("sand")]
   }
}
#declare Fines = pigment {
   granite scale 0.009
   pigment_map {
      [0.28 Aphotic_Pigment ("brown-algae")]
      [0.48 Aphotic_Pigment ("rust-dark.csv")]
      [0.85 Aphotic_Pigment ("sand")]
   }
}
object {
   Sand
   texture {
      pigment {
         function { max(0, min(1, 1.25 * Crest(x, z) + 0.4 * f_noise3d(40 * x, 0, 40 * z) + 0.04)) }
         pigment_map { [0.10 Fines] [0.75 Grains] }
      }
      normal { granite 0.2 scale 0.012 }
      finish { Matt }
   }
}

// --- Iron ---------------------------------------------------------------------------------------

#declare Scale_Rust = pigment {
   granite scale 0.06
   pigment_map {
      [0.22 Aphotic_Pigment ("rust-dark.csv")]
      [0.50 Aphotic_Pigment ("rust-orange.csv")]
      [0.70 Aphotic_Pigment ("rust-dark.csv")]
   }
}
#declare Lime = pigment {
   crackle scale 0.008
   pigment_map {
      [0.05 Aphotic_Pigment ("rust-dark.csv")]
      [0.30 Aphotic_Pigment ("lime-crust.csv")]
   }
}
#declare Coralline = pigment {
   granite scale 0.03
   pigment_map {
      [0.35 Aphotic_Pigment ("red-algae")]
      [0.70 Aphotic_Pigment ("lime-crust.csv")]
   }
}
#declare Rusted = texture {
   pigment {
      bozo warp { turbulence 0.7 octaves 5 omega 0.6 } scale 0.10
      pigment_map { [0.56 Scale_Rust] [0.60 Coralline] [0.70 Coralline] [0.72 Lime] [0.84 Lime] [0.87 Scale_Rust] }
   }
   normal { granite 0.5 scale 0.05 }
   finish { Iron }
}

#declare Anchor = union {
   Anchor_Parts ()
   transform { Anchor_Trans }
}
object { Anchor texture { Rusted } }

// --- Chain: from the ring in a loop over the sand and out of the picture ------------------------

#declare Link_Long = 0.074;
#declare Link = object { Link_Mesh (Link_Long, 0.046, 0.0125) }
#declare Course = spline {
   cubic_spline
   -1, Ring + <-0.10, 0, -0.06>
    0, Ring
    1, <0.40, 0, 0.33>
    2, <0.52, 0, 0.12>
    3, <0.34, 0, -0.10>
    4, <0.12, 0, -0.12>
    5, <0.06, 0, -0.28>
    6, <0.24, 0, -0.37>
    7, <0.46, 0, -0.33>
    8, <0.74, 0, -0.42>
    9, <1.00, 0, -0.60>
}
#macro On_Sand (Place)
   trace(Sand, <Place.x, 1, Place.z>, -y)
#end
// A link is as far from the next as the iron of both allows. It lies half on edge, on its one or
// its other side.
#declare Chain_Step = Link_Long - 2 * 0.0125;
#declare R = seed(7);
#declare At = 0;
#declare Before = Ring;
#declare Count = 0;
#while (At < 7.75)                   // a cubic spline ends before its last point
   // To the point a step on.
   #declare Ahead = At;
   #while (vlength(Course(Ahead) * <1, 0, 1> - Course(At) * <1, 0, 1>) < Chain_Step)
      #declare Ahead = Ahead + 0.004;
   #end
   #declare Next = Course(Ahead);
   #declare Next = On_Sand (Next) + 0.014 * y;
   // Off the ring it comes down by and by.
   #declare Next = Next + y * max(0, Ring.y - Next.y - 0.045 * (Count + 1));
   object {
      Link
      rotate z * ((mod(Count, 2) = 0 ? 42 : -42) + 24 * (rand(R) - 0.5))
      #local Way = vnormalize(Next - Before);
      #local Right = vnormalize(vcross(y, Way));
      #local Up = vcross(Way, Right);
      matrix <Right.x, Right.y, Right.z, Up.x, Up.y, Up.z, Way.x, Way.y, Way.z, 0, 0, 0>
      translate (Before + Next) / 2
      texture { Rusted translate <rand(R), rand(R), rand(R)> * 9 }
   }
   #declare Before = Next;
   #declare At = Ahead;
   #declare Count = Count + 1;
#end
#debug concat("anchor: links ", str(Count, 0, 0), "\n")

// --- Barnacles on the iron ----------------------------------------------------------------------

#declare Barnacle = union {
   #for (I, 0, 5)
      cone { 0, 0.62, <0.12, 1, 0>, 0.22 scale <1, 1, 0.55> translate 0.34 * x rotate 60 * I * y }
   #end
}
#for (I, 1, 2600)
   #local Start = <(rand(R) - 0.5) * 1.1, 1, (rand(R) - 0.5) * 0.9>;
   #local Size = 0.0030 + 0.0055 * pow(rand(R), 2);
   #local Chance = rand(R);
   #local Normal = <0, 0, 0>;
   #local Place = trace(Anchor, Start, -y, Normal);
   #if (vlength(Normal) > 0)
      #if (Normal.y > 0.25 & f_noise3d(14 * Place.x, 14 * Place.y, 14 * Place.z) > 0.42 + 0.25 * Chance)
         #local Right = vnormalize(vcross(Normal, z));
         #local Ahead_Way = vcross(Right, Normal);
         object {
            Barnacle
            scale Size
            matrix <Right.x, Right.y, Right.z, Normal.x, Normal.y, Normal.z,
                    Ahead_Way.x, Ahead_Way.y, Ahead_Way.z, Place.x, Place.y, Place.z>
            pigment { Aphotic_Pigment ("lime-crust.csv") }
            finish { Matt }
         }
      #end
   #end
#end

// --- Pebbles and bits of shell -------------------------------------------------------------------

#for (I, 1, 300)
   #local Start = <(rand(R) - 0.5) * Width, 0, (rand(R) - 0.5) * Depth * 0.98>;
   #local Size = 0.0018 + 0.007 * pow(rand(R), 4);
   #local Turn = 360 * rand(R);
   #local Kind = rand(R);
   sphere {
      0, 1
      scale <1, 0.5, 0.7> * Size
      rotate Turn * y
      translate On_Sand (Start)
      pigment {
         #if (Kind < 0.35) Aphotic_Pigment ("rust-dark.csv")
         #elseif (Kind < 0.55) Aphotic_Pigment ("red-algae")
         #else Aphotic_Pigment ("lime-crust.csv")
         #end
      }
      finish { Matt }
   }
#end
