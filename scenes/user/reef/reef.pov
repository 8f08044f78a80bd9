// This work is licensed under the BSD 3-Clause License (SPDX-License-Identifier: BSD-3-Clause).
//
//    Persistence of Vision Ray Tracer version 3.7 Scene File
//    File: reef.pov
//    Description: A channel of rippled sand between rocks, with scallops, a sea star and algae, as
//                 a survey sled 1.5 m above sees it by its four strobes.
//
//    aphotic render scenes/user/reef/reef.toml --antialias 2 -o out/reef
//
//    A quick look, from this folder:
//
//    povray +L../../../plugin/include +Ireef.pov +W680 +H512 +A0.3
//
// World: y up, metres; x to the right of the picture, z to its top; the sand at about y = 0.

#version 3.7;

#include "functions.inc"
#declare Aphotic_Soft_Edge = 4;       // as a lens and its diffuser soften a beam's edge
#include "aphotic.inc"
#include "scallop.inc"

#declare Aphotic_Sled = Aphotic_Place_Trans (<0, 1.5, 0>, <0, 0, 0>, z)
Aphotic_Rig ()

#declare Width = 1.36;                // of the piece of sea floor
#declare Depth = 1.06;
#declare Fineness = 1;                // more for smoother ground, in time and memory

#declare Matt = finish { Aphotic_Finish (0, 40) }
#declare Moist = finish { Aphotic_Finish (0.08, 30) }

// --- Sand: ripples that wander, with sharp crests ----------------------------------------------

#declare Wander = function (x, z) { f_noise3d(3.1 * x, 5, 3.1 * z) }
#declare Phase = function (x, z) { 2 * pi / 0.068 * (z * 0.86 - x * 0.5 + 0.16 * Wander(x, z)) }
#declare Crest = function (x, z) { 1 - abs(sin(0.5 * Phase(x, z))) }
#declare Sand_Height = function (x, z) {
   0.015 * pow(Crest(x, z), 1.25) * (0.35 + 1.1 * f_noise3d(2.2 * x, 1, 2.2 * z))
   + 0.03 * f_noise3d(2.5 * x, 9, 2.5 * z)
   + 0.0020 * f_noise3d(90 * x, 2, 90 * z)
}
#declare Sand_Top = 0.05;

#declare Sand = height_field {
   function int(760 * Fineness), int(590 * Fineness) {
      Sand_Height((x - 0.5) * Width, (0.5 - y) * Depth) / Sand_Top
   }
   smooth
   translate <-0.5, 0, -0.5>
   scale <Width, Sand_Top, Depth>
}

// Grains and crumbs of shell, and the dark fines that gather in the troughs.
#declare Grains = pigment {
   granite scale 0.009
   pigment_map {
      [0.14 Aphotic_Pigment ("brown-algae")]
      [0.32 Aphotic_Pigment ("rock.csv")]
      [0.42 Aphotic_Pigment ("sand")]
      [0.70 Aphotic_Pigment ("sand")]
      [0.84 Aphotic_Pigment ("scallop-cream.csv")]
   }
}
#declare Fines = pigment {
   granite scale 0.009
   pigment_map {
      [0.30 Aphotic_Pigment ("brown-algae")]
      [0.50 Aphotic_Pigment ("rock.csv")]
      [0.85 Aphotic_Pigment ("sand")]
   }
}
object {
   Sand
   texture {
      pigment {
         function { max(0, min(1, 1.35 * Crest(x, z) + 0.4 * f_noise3d(40 * x, 0, 40 * z) - 0.08)) }
         pigment_map { [0.15 Fines] [0.70 Grains] }
      }
      normal { granite 0.22 scale 0.012 }
      finish { Matt }
   }
}

// --- Rock: boulders of cells, on either side of the channel ------------------------------------

#declare Boulders = function { pattern { crackle form <-1, 1, 0> warp { turbulence 0.22 octaves 3 lambda 2.2 } scale 0.23 } }
#declare Stones = function { pattern { crackle form <-1, 1, 0> warp { turbulence 0.2 octaves 2 } scale 0.071 } }
#declare Channel = function (x, z) { z - 0.42 * x + 0.02 - 0.07 * sin(5.5 * x + 0.7) }
#declare Bank = function (x, z) {
   max(0, min(1, (abs(Channel(x, z)) - 0.10 + 0.22 * (f_noise3d(6 * x, 3, 6 * z) - 0.5)) / 0.24))
}
#declare Rock_Height = function (x, z) {
   Bank(x, z) * (0.12 + 0.17 * f_noise3d(4.3 * x + 3, 7, 4.3 * z))
   * (0.30 + 0.70 * pow(min(1, 2.3 * Boulders(x, 0, z)), 0.55))
   + min(1, 3 * Bank(x, z)) * (0.020 * pow(min(1, 2 * Stones(x, 0, z)), 0.6) - 0.012
                               + 0.030 * f_ridged_mf(7 * x, 1, 7 * z, 0.9, 2.3, 5, 0.9, 2, 2) - 0.012)
}
#declare Rock_Top = 0.36;

#declare Rock = height_field {
   function int(900 * Fineness), int(700 * Fineness) {
      Rock_Height((x - 0.5) * Width, (0.5 - y) * Depth) / Rock_Top
   }
   smooth
   water_level 0.004
   translate <-0.5, 0, -0.5>
   scale <Width, Rock_Top, Depth>
   translate -0.004 * y
}

#declare Bare = pigment {
   granite scale 0.09
   pigment_map {
      [0.18 Aphotic_Pigment ("brown-algae")]
      [0.36 Aphotic_Pigment ("rock.csv")]
      [0.58 Aphotic_Pigment ("rock.csv")]
      [0.80 Aphotic_Pigment ("sand")]
   }
}
// Crusts of coralline algae, pink, with paler rims.
#declare Crust = pigment {
   bozo warp { turbulence 0.6 octaves 5 omega 0.6 } scale 0.05
   pigment_map {
      [0.25 Aphotic_Pigment ("red-algae")]
      [0.42 Aphotic_Pigment ("scallop-brick.csv")]
      [0.50 Aphotic_Pigment ("red-algae")]
      [0.72 Aphotic_Pigment ("red-algae")]
      [0.80 Aphotic_Pigment ("scallop-cream.csv")]
   }
}
#declare Turf = pigment {
   granite scale 0.03
   pigment_map {
      [0.25 Aphotic_Pigment ("brown-algae")]
      [0.50 Aphotic_Pigment ("green-algae")]
      [0.75 Aphotic_Pigment ("brown-algae")]
   }
}
#declare Sponge = pigment {
   crackle scale 0.012
   pigment_map {
      [0.10 Aphotic_Pigment ("rock.csv")]
      [0.30 Aphotic_Pigment ("sponge-yellow.csv")]
   }
}
#declare Grown = pigment {
   bozo warp { turbulence 0.7 octaves 6 omega 0.62 lambda 2.1 } scale 0.16 translate 3.3
   pigment_map {
      [0.28 Turf] [0.33 Bare] [0.46 Bare] [0.50 Crust] [0.72 Crust] [0.75 Sponge] [0.82 Sponge] [0.85 Bare]
   }
}
object {
   Rock
   texture {
      pigment { slope y pigment_map { [0.62 Bare] [0.76 Grown] } }
      normal { granite 0.35 scale 0.03 }
      finish { Matt }
   }
}

// --- What lies and grows there ------------------------------------------------------------------

#declare Ground = union { object { Sand } object { Rock } }

// The transform that lays an object on the ground at x and z: its own y along the ground's normal.
#macro Lay_Trans (X, Z, Size, Turn, Sink)
   #local Normal = <0, 0, 0>;
   #local Place = trace(Ground, <X, 1, Z>, -y, Normal);
   #local Up = vnormalize(Normal + 0.8 * y);
   #local Right = vnormalize(vcross(Up, z));
   #local Ahead = vcross(Right, Up);
   transform {
      scale Size
      rotate Turn * y
      matrix <Right.x, Right.y, Right.z, Up.x, Up.y, Up.z, Ahead.x, Ahead.y, Ahead.z, 0, 0, 0>
      translate Place - Sink * Up
   }
#end

#declare Valve = Scallop_Valve (19, 0.20, 8)
#declare Flat_Valve = Scallop_Valve (19, 0.11, 6)

// Rings of growth, each of its own shade, and streaks along the ribs: 0 to 1.
#declare Shell_Shade = function (u, v) {
   0.75 * f_noise3d(2, 11 * v, 0) + 0.35 * f_noise3d(45 * u, 2.5 * v, 4) + 0.25 * f_noise3d(20 * u, 30 * v, 9) - 0.17
}
#declare Brick_Shell = texture {
   uv_mapping
   pigment {
      function { max(0, min(1, Shell_Shade(x, y) + 0.5 * pow(1 - y, 5))) }
      pigment_map {
         [0.12 Aphotic_Pigment ("rock.csv")]
         [0.30 Aphotic_Pigment ("scallop-brick.csv")]
         [0.62 Aphotic_Pigment ("scallop-brick.csv")]
         [0.86 Aphotic_Pigment ("scallop-cream.csv")]
      }
   }
   finish { Moist }
}
#declare Cream_Shell = texture {
   uv_mapping
   pigment {
      function { max(0, min(1, Shell_Shade(x + 3, y + 5) - 0.5 * pow(1 - y, 4))) }
      pigment_map {
         [0.00 Aphotic_Pigment ("scallop-brick.csv")]
         [0.26 Aphotic_Pigment ("red-algae")]
         [0.46 Aphotic_Pigment ("scallop-cream.csv")]
         [0.70 Aphotic_Pigment ("scallop-cream.csv")]
         [0.90 Aphotic_Pigment ("sand")]
      }
   }
   finish { Moist }
}

// A live scallop: two valves, a little open.
#macro Scallop (X, Z, Size, Turn, Shell)
   union {
      object { Valve rotate -7 * x translate 0.03 * y }
      object { Flat_Valve scale <1, -1, 1> }
      texture { Shell }
      translate <0, 0.06, -0.5>
      transform { Lay_Trans (X, Z, Size, Turn, 0.004) }
   }
#end

Scallop (-0.045, -0.040, 0.150, -35, Brick_Shell)
Scallop (0.165, 0.030, 0.125, 150, Cream_Shell)
Scallop (-0.235, -0.155, 0.110, 80, Cream_Shell)
Scallop (0.37, 0.165, 0.135, 20, Brick_Shell)
Scallop (0.06, -0.165, 0.085, 210, Brick_Shell)

// --- A sea star ---------------------------------------------------------------------------------

#declare Star_Place = <-0.385, 0, -0.262>;
#declare Star_Turns = 200;
#declare Star_Rings = 40;
#macro Star_Point (I, J)
   #local Angle = 2 * pi * I / Star_Turns;
   #local Share = J / Star_Rings;
   // Five arms, each bent a little its own way.
   #local Arm = pow(0.5 + 0.5 * cos(5 * Angle), 1.7);
   #local Out = Share * (0.17 + 0.83 * Arm * (1 - 0.12 * sin(Angle)));
   #local Bent = Angle + 0.22 * sin(2 * Angle + 1) * Out * Out;
   #local Bump = 0.008 * sin(36 * Share) * cos(50 * Angle) * (1 - Share);
   <Out * sin(Bent), 0.20 * sqrt(max(0, 1 - Share * Share)) * (1 - 0.42 * Out) + Bump, Out * cos(Bent)>
#end
#declare Star = mesh2 {
   vertex_vectors {
      (Star_Turns + 1) * (Star_Rings + 1)
      #for (J, 0, Star_Rings) #for (I, 0, Star_Turns) , Star_Point (I, J) #end #end
   }
   face_indices {
      2 * Star_Turns * Star_Rings
      Scallop_Quads (0, Star_Turns, Star_Rings)
   }
}
object {
   Star
   texture {
      pigment {
         bozo scale 0.05
         pigment_map {
            [0.45 Aphotic_Pigment ("star-orange.csv")]
            [0.75 Aphotic_Pigment ("scallop-brick.csv")]
            [0.85 Aphotic_Pigment ("scallop-cream.csv")]
         }
      }
      normal { crackle 0.6 scale 0.06 }
      finish { Moist }
   }
   transform { Lay_Trans (Star_Place.x, Star_Place.z, 0.090, 25, -0.002) }
}

// --- Tufts of algae -----------------------------------------------------------------------------

// A tuft is a mesh of blades: bands that rise, lean out and taper. About 1 high.
#macro Tuft (Blades, Broad, Spread, Seed)
   #local R = seed(Seed);
   #local Steps = 7;
   mesh {
      #for (B, 1, Blades)
         #local Turn = 2 * pi * rand(R);
         #local Lean = Spread * (0.25 + rand(R));
         #local High = 0.55 + 0.45 * rand(R);
         #local Way = <cos(Turn), 0, sin(Turn)>;
         #local Curl = 0.25 * (rand(R) - 0.5);
         #local Side = <-sin(Turn), 0, cos(Turn)> * Broad * (0.6 + 0.6 * rand(R));
         #local Foot = 0.10 * <rand(R) - 0.5, 0, rand(R) - 0.5>;
         #for (K, 0, Steps - 1)
            #local S = K / Steps;
            #local T = (K + 1) / Steps;
            #local P = Foot + High * (y * (S - 0.35 * Spread * S * S) + Way * Lean * S * S + vcross(y, Way) * Curl * sin(5 * S));
            #local Q = Foot + High * (y * (T - 0.35 * Spread * T * T) + Way * Lean * T * T + vcross(y, Way) * Curl * sin(5 * T));
            #local P_Side = Side * (0.35 + sin(pi * pow(S, 0.8)));
            #local Q_Side = Side * (0.35 + sin(pi * pow(T, 0.8))) * (T < 1);
            triangle { P - P_Side, P + P_Side, Q + Q_Side }
            triangle { P - P_Side, Q + Q_Side, Q - Q_Side }
         #end
      #end
   }
#end
#declare Tufts = array[3];
#declare Tufts[0] = Tuft (70, 0.022, 0.9, 11)
#declare Tufts[1] = Tuft (46, 0.045, 1.1, 12)
#declare Tufts[2] = Tuft (110, 0.014, 0.8, 13)
#declare Weeds = array[3] {"green-algae", "red-algae", "brown-algae"}

// They grow on the heights of the rock, in groups.
#declare R = seed(2024);
#declare Grown_Count = 0;
#for (I, 1, 1600)
   #local X = (rand(R) - 0.5) * (Width - 0.1);
   #local Z = (rand(R) - 0.5) * (Depth - 0.1);
   #local Kind = int(2.999 * max(0, min(1, 0.5 + 2.6 * (f_noise3d(5 * X + 8, 4, 5 * Z) - 0.5))));
   #local Size = 0.016 + 0.040 * rand(R);
   #local Turn = 360 * rand(R);
   #if (f_noise3d(11 * X, 6, 11 * Z) > 0.62 & Rock_Height(X, Z) > 0.06 & vlength(<X, 0, Z> - Star_Place) > 0.12)
      #declare Grown_Count = Grown_Count + 1;
      object {
         Tufts[Kind]
         texture {
            pigment {
               gradient y
               pigment_map {
                  [0.0 Aphotic_Pigment ("brown-algae")]
                  [0.5 Aphotic_Pigment (Weeds[Kind])]
               }
            }
            finish { Moist }
         }
         transform { Lay_Trans (X, Z, Size, Turn, 0.003) }
      }
   #end
#end
#debug concat("reef: tufts ", str(Grown_Count, 0, 0), "\n")

// --- Pebbles and broken shell on the sand -------------------------------------------------------

#for (I, 1, 260)
   #local X = (rand(R) - 0.5) * Width;
   #local Z = 0.42 * X + 0.34 * (rand(R) - 0.5) + 0.07 * sin(5.5 * X + 0.7);
   #local Size = 0.002 + 0.007 * pow(rand(R), 3);
   #local Turn = 360 * rand(R);
   #local Kind = rand(R);
   #if (abs(Z) < 0.49 * Depth)
      sphere {
         0, 1
         scale <1, 0.55, 0.7>
         texture {
            pigment {
               #if (Kind < 0.4) Aphotic_Pigment ("rock.csv")
               #elseif (Kind < 0.6) Aphotic_Pigment ("red-algae")
               #else Aphotic_Pigment ("scallop-cream.csv")
               #end
            }
            finish { Matt }
         }
         transform { Lay_Trans (X, Z, Size, Turn, 0.001) }
      }
   #end
#end
