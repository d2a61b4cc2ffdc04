// Tolerances that shaders and C++ share: the C++ side is host_app/views/tolerances.h, which reads this file with another
// definition of TOLERANCE. Colours are 0 to 1; a colour difference is the mean over red, green and blue.
#ifndef TOLERANCES
#define TOLERANCES
#ifndef TOLERANCE
#define TOLERANCE(name, value) const float name = value;
#endif

// Standard deviation of a stereo disparity, px. The relative uncertainty of a depth z follows from it as
// z * disparity_sigma_px / (f_px * baseline_m); shaders get the factor of z as the uniform `spread`.
TOLERANCE(disparity_sigma_px, 0.15)

// Two neighbouring depths of one rig with a larger ratio lie on two surfaces.
TOLERANCE(depth_edge_ratio, 1.04)
// The same as a share of the depth, for depths that several rigs agree on: in a rendered view and between baked tiles.
TOLERANCE(view_edge_share, 0.03)
// Relative depth difference up to which the surfaces of two rigs are blended as one in a rendered view.
TOLERANCE(same_surface_share, 0.005)

// Two depths of one place are one surface if they differ by less than a fixed share of the depth (errors of calibration
// and matching that do not depend on the distance) plus so many standard deviations of the disparity.
TOLERANCE(surface_share, 0.02)          // between rigs, and between a matched background and the one it was matched from
TOLERANCE(steady_surface_share, 0.002)  // between instants of one rig, whose systematic errors are the same each time
TOLERANCE(surface_sigmas, 4.0)          // if a wrong "different" costs more than a wrong "same"
TOLERANCE(consistent_sigmas, 2.0)       // for carving and confirming, per rig: both rigs add theirs

// A relative depth difference within which another rig may show the same place at all; farther off it shows another
// surface. Wide, since single maps err by several per cent before refinement.
TOLERANCE(same_place_share, 0.05)
// The same for the plane sweep, which corrects larger errors: its sixteen steps reach about so far.
TOLERANCE(sweep_place_share, 0.08)
// A background nearer than this share of a point's depth hides the point from its rig.
TOLERANCE(hiding_share, 0.95)

// Colour difference at which the weight of a neighbouring pixel falls to 1/e, when pixels of one surface are averaged:
TOLERANCE(window_colour_falloff, 0.1)      // costs, which tolerate a few foreign pixels
TOLERANCE(smoothing_colour_falloff, 0.08)  // depths
TOLERANCE(inpaint_colour_falloff, 0.03)    // depth for a pixel that has none, where a wrong surface shows most

// Mean colour difference of two rigs' images of one place: below the first it is one surface, above the second it is not.
TOLERANCE(matching_cost, 0.08)
TOLERANCE(mismatching_cost, 0.09)
// The same over nine pixels, to confirm a depth that both rigs' matchers found: repetitive structure deceives both.
TOLERANCE(confirming_cost, 0.05)
// Costs are limited to this, so that one occlusion or edge in a window does not decide.
TOLERANCE(max_pixel_cost, 0.15)

// Largest change of red, green or blue between an image and the background's mean that is still sensor noise, and the one
// from which the pixel shows something else. Measured on the virtual stage's sensors with 2 grey levels of noise.
TOLERANCE(noise_change, 0.01)
TOLERANCE(motion_change, 0.02)

#undef TOLERANCE
#endif
