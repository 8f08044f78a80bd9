// Light through a grille: its bars stand between the strobe and what the camera sees.
//
// Metres. x starboard, y forward, z down; the camera is at the origin.

#version 3.7;
#include "aphotic.inc"

Aphotic_Rig ()
Aphotic_Rig_Seafloor ()

// Across the strobe's axis, a quarter of a metre from it.
#local Along_Axis = vrotate(z, y * -50);
#local Middle = <0.8, 0, 0.5> + 0.25 * Along_Axis;
#local Along_Bar = vcross(y, Along_Axis);

#for (I, -3, 3)
   cylinder {
      Middle + y * 0.06 * I - 0.25 * Along_Bar, Middle + y * 0.06 * I + 0.25 * Along_Bar, 0.014
      pigment { rgb 0.05 }
      finish { Aphotic_Finish (0, 0) }
   }
#end

Aphotic_End ()
