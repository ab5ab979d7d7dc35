// Three transparent spheres on a checker, as near as POV-Ray comes to three_spheres.toml beside this file: the same
// numbers, the same frame (right-handed, y up), linear colours. README.md explains the settings.
//
// From the command line: Declare=MaxDepth=N, vitrum's max_depth (the primary ray has depth 0).
#version 3.7;

#ifndef (MaxDepth) #declare MaxDepth = 10; #end

global_settings {
    assumed_gamma 1
    // POV-Ray counts from 1 where vitrum counts from 0: it traces while the level is below this number.
    max_trace_level MaxDepth + 1
    // No ray is dropped for its weight.
    adc_bailout 0
}

#declare Eye = <0, 4, 9>;
#declare Lamp = <4, 7, 5>;
#declare FieldOfView = 32; // vertical, degrees
#declare Kr = 0.1;
#declare Kt = 0.9;
#declare Ks = 0.1;
#declare Exponent = 2000;

background { rgb <0.35, 0.5, 0.75> }

// `right` points to -x, which makes POV-Ray's left-handed camera a right-handed one.
camera {
    location Eye
    direction 0.5 / tan(radians(FieldOfView) / 2) * z
    up y
    right -image_width / image_height * x
    look_at <0, 0.8, 0>
}

// No falloff. POV-Ray has no 1/pi in its Lambert term: rgb 1 here is an intensity of pi W/sr there.
light_source { Lamp rgb 1 }

// The pattern is moved by half a cell, so that the floor runs through the middle of its cells and not along a border.
plane {
    y, 0
    pigment { checker rgb 0.8 rgb 0.15 translate -0.5 * y }
    finish { ambient 0 diffuse 1 }
}

// Kr and Kt are the same at every angle (no `fresnel`, no `conserve_energy`).
//
// The highlight: vitrum's is Ks cos^e(alpha) times pi (the light) times the cosine at the light, POV-Ray's `phong` has
// no such cosine. It is put into the coefficient, taken where the highlight is: where the normal halves the angle
// between eye and lamp.
//
// The shadow: POV-Ray lets light pass through transparent objects undeflected, the comparison wants opaque shadows.
// So the glass casts none, and an opaque twin, which no eye ray meets, casts it.
#macro Glass(Centre, Radius)
    #local Halfway = vnormalize(vnormalize(Eye - Centre) + vnormalize(Lamp - Centre));
    #local CosLight = vdot(Halfway, vnormalize(Lamp - Centre));
    sphere {
        Centre, Radius
        pigment { rgbt <1, 1, 1, Kt> }
        finish { ambient 0 diffuse 0 phong Ks * pi * CosLight phong_size Exponent reflection { Kr } }
        interior { ior 1.5 }
        no_shadow
    }
    sphere {
        Centre, Radius
        pigment { rgb 0 }
        finish { ambient 0 diffuse 0 }
        no_image
        no_reflection
    }
#end

Glass(<-2.3, 1.02, -0.6>, 1)
Glass(<0, 1.02, 0.4>, 1)
Glass(<2.2, 0.82, 0.9>, 0.8)
