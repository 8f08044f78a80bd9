// This work is licensed under the BSD 3-Clause License (SPDX-License-Identifier: BSD-3-Clause).
//
//    Persistence of Vision Ray Tracer version 3.7 Scene File
//    File: survey.pov
//    Description: One image of a simulated survey: random patches of sand, algae and gravel, with
//                 rocks and shells on them, and in some images the tiles of a grey chart.
//
// `aphotic survey` declares what differs from image to image before it includes this file. Without
// that, the sled is level at the lowest altitude that surveys fly:
//
//    Survey_Image      its number: the first five, and then every tenth, have the chart
//    Survey_Seed       of all that is random
//    Survey_Altitude   of the sled in metres, along its z
//    Survey_Pitch      degrees, bow up
//    Survey_Roll       degrees, starboard down
//
// and --declare the floor, in place of the sea's:
//
//    Survey_Floor      "sea", or "card": one grey card all over with nothing on it, which is what
//                      the chart would look like everywhere; or "hills" of grey gravel
//
// A quick look, from this folder:
//
//    povray +L../../plugin/include +Isurvey.pov +W680 +H512 Declare=Survey_Seed=7

#version 3.7;
#include "aphotic.inc"

#ifndef (Survey_Image) #declare Survey_Image = 1; #end
#ifndef (Survey_Seed) #declare Survey_Seed = 0; #end
#ifndef (Survey_Altitude) #declare Survey_Altitude = 1.3; #end
#ifndef (Survey_Pitch) #declare Survey_Pitch = 0; #end
#ifndef (Survey_Roll) #declare Survey_Roll = 0; #end
#ifndef (Survey_Floor) #declare Survey_Floor = "sea"; #end

Aphotic_Rig ()

#declare R = seed(Survey_Seed);
#macro Between (Least, Most) (Least + (Most - Least) * rand(R)) #end

// The floor's own frame: x to starboard, y up, z forward, the origin below the camera. What lies
// on the floor is built there and moved into the sled's.
#declare P = radians(Survey_Pitch);
#declare Q = radians(Survey_Roll);
#declare Up = <-cos(P) * sin(Q), sin(P), -cos(P) * cos(Q)>;
#declare Forward = vnormalize(y - vdot(y, Up) * Up);
#declare Starboard = vcross(Up, Forward);
#declare Floor_Trans = transform {
   matrix <Starboard.x, Starboard.y, Starboard.z, Up.x, Up.y, Up.z,
           Forward.x, Forward.y, Forward.z, 0, 0, Survey_Altitude>
}

#declare Half_Width = 1.7;           // of the floor that any image sees, and of what shades it
#declare Half_Depth = 1.5;
#declare Card = 0.18;                // as of scenes/grey-card.csv, the floor of the rig
#declare Matt = finish { Aphotic_Finish (0, 0) }

// --- The ground: patches of a hand to a metre -----------------------------------------------------

#declare Gravel = pigment {
   crackle solid scale 0.02
   pigment_map {
      [0.35 Aphotic_Pigment ("rock.csv")]
      [0.60 Aphotic_Pigment ("sand")]
      [0.90 Aphotic_Pigment ("brown-algae")]
   }
}
#declare Sand = pigment {
   granite scale 0.03
   pigment_map {
      [0.25 Aphotic_Pigment ("rock.csv")]
      [0.50 Aphotic_Pigment ("sand")]
   }
}
#declare Turf = pigment {
   granite scale 0.05
   pigment_map {
      [0.30 Aphotic_Pigment ("green-algae")]
      [0.50 Aphotic_Pigment ("brown-algae")]
      [0.60 Aphotic_Pigment ("sand")]
   }
}
#declare Crust = pigment {
   bozo turbulence 0.5 scale 0.04
   pigment_map {
      [0.40 Aphotic_Pigment ("red-algae")]
      [0.60 Aphotic_Pigment ("rock.csv")]
   }
}
#macro Ground ()
   plane {
      y, 0
      texture {
         pigment {
            bozo
            warp { turbulence 0.6 octaves 4 }
            scale Between (0.15, 0.5)
            pigment_map { [0.30 Turf] [0.36 Sand] [0.58 Sand] [0.62 Gravel] [0.72 Gravel] [0.76 Crust] }
         }
         finish { Matt }
         rotate Between (0, 360) * y
         translate <Between (-50, 50), Between (-50, 50), Between (-50, 50)>
      }
   }
#end

// --- What lies on it --------------------------------------------------------------------------------

#macro Scattered () <Between (-Half_Width, Half_Width), 0, Between (-Half_Depth, Half_Depth)> #end

// Half sunk, of several overlapping lumps.
#macro Rock ()
   #local Size = Between (0.04, 0.11);
   union {
      #for (K, 1, 4)
         sphere {
            0, 1
            scale Size * <Between (0.5, 1), Between (0.3, 0.8), Between (0.5, 1)>
            rotate Between (0, 180) * y
            translate 0.5 * Size * <Between (-1, 1), 0, Between (-1, 1)>
         }
      #end
      pigment {
         granite scale 0.1
         pigment_map {
            [0.30 Aphotic_Pigment ("brown-algae")]
            [0.45 Aphotic_Pigment ("rock.csv")]
            [0.70 Aphotic_Pigment ("red-algae")]
         }
      }
      finish { Matt }
      translate Scattered ()
   }
#end

#macro Shell ()
   #local Size = Between (0.03, 0.065);
   sphere {
      0, 1
      pigment {
         onion phase rand(R) frequency 4
         pigment_map {
            [0.2 Aphotic_Pigment ("scallop-brick.csv")]
            [0.7 Aphotic_Pigment ("scallop-cream.csv")]
         }
      }
      finish { Matt }
      translate -z
      scale Size * <1, 0.25, 0.9>
      rotate Between (0, 360) * y
      translate Scattered ()
   }
#end

// --- The chart: grey tiles over all the view, light and dark by turns ------------------------------

// Sheets far thinner than what POV-Ray lets cast a shadow (0.001), a ten-thousandth of the altitude.
#declare Sheet = 0.0002;
#declare Tile = 0.1;
#declare Spacing = 0.25;
#macro Chart ()
   #local First = <Between (0, Spacing), 0, Between (0, Spacing)> - <Half_Width, 0, Half_Depth>;
   union {
      #for (J, 0, 2 * Half_Depth / Spacing - 1)
         #for (I, 0, 2 * Half_Width / Spacing - 1)
            box {
               <0, -Sheet, 0>, <Tile, Sheet, Tile>
               pigment { rgb #if (mod(I + J, 2) = 0) 2.5 * Card #else Card #end }
               translate First + Spacing * <I, 0, J>
            }
         #end
      #end
      finish { Matt }
      rotate Between (-30, 30) * y
   }
#end

// --- Hills, caps of balls up to 0.25 m high -----------------------------------------------------------

#macro Hill ()
   #local Size = Between (0.4, 1.0);
   #local Rise = Between (0.05, 0.25);
   sphere { <Between (-1.9, 1.9), Rise - Size, Between (-1.7, 1.7)>, Size }
#end
#macro Hills ()
   union {
      plane { y, 0 }
      #for (K, 1, 30) Hill () #end
      pigment {
         granite scale 0.3 color_map { [0 rgb 0.08] [1 rgb 0.28] }
         translate <Between (-50, 50), Between (-50, 50), Between (-50, 50)>
      }
      finish { Matt }
   }
#end

// --- The image --------------------------------------------------------------------------------------

#if (strcmp(Survey_Floor, "card") = 0)
   plane { y, 0  pigment { rgb Card }  finish { Matt }  transform { Floor_Trans } }
#elseif (strcmp(Survey_Floor, "hills") = 0)
   object { Hills () transform { Floor_Trans } }
#else
   union {
      Ground ()
      #for (K, 1, 12) Rock () #end
      #for (K, 1, 40) Shell () #end
      #if (Survey_Image <= 5 | mod(Survey_Image, 10) = 0) Chart () #end
      transform { Floor_Trans }
   }
#end

Aphotic_End ()
