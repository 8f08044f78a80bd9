// This work is licensed under the BSD 3-Clause License (SPDX-License-Identifier: BSD-3-Clause).
//
//    Persistence of Vision Ray Tracer version 3.7 Scene File
//    File: chart.pov
//    Description: A colour chart twice: on a stand 0.8 m below the camera, and on the sand at 1.8 m.
//
//    aphotic render scenes/user/chart/chart.toml --antialias 2 -o out/chart
//
//    A quick look, from this folder:
//
//    povray +L../../../plugin/include +Ichart.pov +W680 +H512 +A0.3
//
// World: the sled's own frame, in metres: x to the right of the picture, y to its top, z down from
// the camera.
//
// The patches, for who wants to check them: their faces are squares of 0.040 by 0.040 m in planes
// of constant z, 0.045 m apart, six in a row. The middle of the patch in column C (0 to 5, from the
// left) and row R (0 to 3, from the top) is
//
//    near chart   <-0.2425 + 0.045 C,   0.1825 - 0.045 R,   0.8>
//    far chart    < 0.2675 + 0.045 C,  -0.1725 - 0.045 R,   1.8>
//
// and holds patch 6 R + C + 1 of the folder patches. Nothing shades a patch. The far patches lie
// within 4.9 degrees of the axes of all four strobes, where the spots are at full strength, the near
// ones 8.0 degrees and more off them, where there is no spot.

#version 3.7;

#include "functions.inc"
#declare Aphotic_Soft_Edge = 0.8;     // of the spots: from 6.2 to 7.8 degrees off their axes
#include "aphotic.inc"

Aphotic_Rig ()

// A patch's spectrum.
#macro Patch (Name)
   Aphotic_Pigment (concat("patches/", Name, ".csv"))
#end

#declare Matt = finish { Aphotic_Finish (0, 40) }
#declare Glossy = finish { Aphotic_Finish (0.15, 60) }

// --- The charts ---------------------------------------------------------------------------------

#declare Patch_Size = 0.040;
#declare Patch_Pitch = 0.045;
#declare Patch_Names = array[24] {
   "01-dark-skin", "02-light-skin", "03-blue-sky", "04-foliage", "05-blue-flower", "06-bluish-green",
   "07-orange", "08-purplish-blue", "09-moderate-red", "10-purple", "11-yellow-green", "12-orange-yellow",
   "13-blue", "14-green", "15-red", "16-yellow", "17-magenta", "18-cyan",
   "19-white", "20-neutral-8", "21-neutral-6-5", "22-neutral-5", "23-neutral-3-5", "24-black"
}

// First: the middle of the face of the first patch. The board ends 2 mm under the faces.
#macro Chart (First)
   #local Margin = <0.030, -0.030, 0>;
   #local Last = First + <5 * Patch_Pitch, -3 * Patch_Pitch, 0>;
   #local Half = Patch_Size / 2 * <1, 1, 0>;
   union {
      #for (I, 0, 23)
         #local Middle = First + Patch_Pitch * <mod(I, 6), -int(I / 6), 0>;
         box {
            Middle - Half, Middle + Half + 0.006 * z
            pigment { Patch (Patch_Names[I]) }
            finish { Matt }
         }
      #end
      // The board, with round corners.
      union {
         #local A = First - Margin + 0.002 * z;
         #local B = Last + Margin + 0.010 * z;
         #local Round = 0.012;
         box { <A.x + Round, B.y, A.z>, <B.x - Round, A.y, B.z> }
         box { <A.x, B.y + Round, A.z>, <B.x, A.y - Round, B.z> }
         cylinder { <A.x + Round, A.y - Round, A.z>, <A.x + Round, A.y - Round, B.z>, Round }
         cylinder { <B.x - Round, A.y - Round, A.z>, <B.x - Round, A.y - Round, B.z>, Round }
         cylinder { <A.x + Round, B.y + Round, A.z>, <A.x + Round, B.y + Round, B.z>, Round }
         cylinder { <B.x - Round, B.y + Round, A.z>, <B.x - Round, B.y + Round, B.z>, Round }
         pigment { Patch ("24-black") }
         finish { Glossy }
      }
   }
#end

Chart (<-0.2425, 0.1825, 0.8>)
Chart (<0.2675, -0.1725, 1.8>)

// --- The stand ----------------------------------------------------------------------------------

#macro Leg (Top, Foot)
   union {
      cylinder { Top, Foot, 0.009 }
      sphere { Top, 0.013 }
      // A lead weight.
      cylinder { Foot - 0.025 * z, Foot + 0.02 * z, 0.045 }
      cylinder { Foot - 0.032 * z, Foot - 0.025 * z, 0.037 }
   }
#end
union {
   Leg (<-0.13, 0.115, 0.825>, <0.21, 0.28, 1.81>)
   Leg (<-0.13, 0.115, 0.825>, <-0.20, -0.20, 1.81>)
   Leg (<-0.13, 0.115, 0.825>, <-0.55, 0.40, 1.81>)
   cylinder { <-0.13, 0.115, 0.81>, <-0.13, 0.115, 0.85>, 0.03 }
   pigment { Patch ("22-neutral-5") }
   finish { Aphotic_Finish (0.6, 50) }
}

// --- Sand ---------------------------------------------------------------------------------------

#declare Width = 1.7;
#declare Depth = 1.3;
#declare Wander = function (x, y) { f_noise3d(2.6 * x, 3, 2.6 * y) }
#declare Phase = function (x, y) { 2 * pi / 0.085 * (y * 0.80 + x * 0.6 + 0.20 * Wander(x, y)) }
#declare Crest = function (x, y) { 1 - abs(sin(0.5 * Phase(x, y))) }
#declare Sand_Height = function (x, y) {
   0.018 * pow(Crest(x, y), 1.25) * (0.45 + f_noise3d(2 * x, 1, 2 * y)) + 0.02 * f_noise3d(2.5 * x, 9, 2.5 * y)
   + 0.0020 * f_noise3d(90 * x, 2, 90 * y)
}
#declare Sand_Top = 0.05;
#declare Grains = pigment {
   granite scale 0.013
   pigment_map {
      [0.14 Aphotic_Pigment ("brown-algae")]
      [0.32 Patch ("22-neutral-5")]
      [0.42 Aphotic_Pigment ("sand")]
      [0.70 Aphotic_Pigment ("sand")]
      [0.84 Patch ("20-neutral-8")]
   }
}
#declare Fines = pigment {
   granite scale 0.011
   pigment_map {
      [0.30 Aphotic_Pigment ("brown-algae")]
      [0.50 Patch ("01-dark-skin")]
      [0.85 Aphotic_Pigment ("sand")]
   }
}
height_field {
   function 850, 650 { Sand_Height((x - 0.5) * Width, (0.5 - y) * Depth) / Sand_Top }
   smooth
   translate <-0.5, 0, -0.5>
   scale <Width, Sand_Top, Depth>
   // From y up to z down; its crests are at 1.81 m, under the far chart's board.
   matrix <1, 0, 0,  0, 0, -1,  0, 1, 0,  0, 0, 1.85>
   texture {
      pigment {
         function { max(0, min(1, 1.2 * Crest(x, y) + 0.4 * f_noise3d(40 * x, 0, 40 * y) + 0.08)) }
         pigment_map { [0.10 Fines] [0.80 Grains] }
      }
      normal { granite 0.2 scale 0.012 }
      finish { Matt }
   }
}
