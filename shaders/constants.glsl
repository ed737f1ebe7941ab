// Numbers that the shaders and the kernels on the processor share. Both read this file: it is GLSL,
// and C++ through render/light/shading_constants.h. Colours are linear.

// Kinds of surface in the G-buffer.
const int kind_nothing = 0;
const int kind_ground = 1;
const int kind_solid = 2;
const int kind_snow = 3;
const int kind_attribute = 4;
const int kind_flat = 5;  // shown in its own colour, without light
const int kind_lit = 6;   // light is in its colour already
const int kind_holdout = 7;  // hides what is behind it and shows the background, in shadow

// Light that falls on things.
const vec3 sun_color = vec3(1.30f, 1.22f, 1.08f);
const vec3 sky_color = vec3(0.42f, 0.56f, 0.80f);
const vec3 bounce_color = vec3(0.23f, 0.29f, 0.38f);
const vec3 scatter_color = vec3(0.10f, 0.16f, 0.24f);
const vec3 background_top = vec3(0.060f, 0.072f, 0.098f);
const vec3 background_bottom = vec3(0.190f, 0.215f, 0.260f);

// Matte surfaces.
const float facing_wrap = 0.3f;  // how far light reaches around an edge
const float facing_min = 0.65f;
const float facing_gain = 0.35f;
// Light that has gone through snow is bluer: red is absorbed first.
const vec3 absorption = vec3(0.90f, 0.78f, 0.66f);
const float ambient_min = 0.08f;
const float ambient_gain = 0.92f;
const float ambient_share = 0.75f;
const float inside_gain = 0.6f;  // light that was scattered inside
const float inside_min = 0.15f;
const float value_contrast = 0.6f;  // of colours that show values: lifts the shadows
const float rim_light = 0.35f;      // of solids, of the sky's colour

// Snow: the body decides the shape, the sphere gives the grain.
const float body_share = 0.72f;

// Distance from a surface at which its light is read, in cells of its volume.
const float ground_offset = 0.5f;
const float solid_offset = 2.5f;
const float snow_offset = 1.2f;
const float entry_offset = 0.5f;     // of a ray towards the light that enters the volume
const float sky_fade_cells = 3.5f;   // over which the sky goes over to all of it, at the edge

// From linear light to the display.
const float exposure = 0.8f;
const float white_point = 4.84f;
const float shoulder = 0.55f;
const float display_gamma = 2.2f;
const float vignette_strength = 0.35f;

// A random number for each sample, and one that is even over every few neighbours.
const uint noise_column = 0x9E3779B1u;
const uint noise_row = 0x85EBCA77u;
const uint noise_mix_1 = 0x2C1B3C6Du;
const uint noise_mix_2 = 0x297A2D39u;
const float even_noise_scale = 52.9829189f;
const float even_noise_column = 0.06711056f;
const float even_noise_row = 0.00583715f;

// Lines on the ground.
const float line_brightness = 0.34f;
const float line_veil_first = 0.08f;  // lines a sample: closer than that they fade
const float line_veil_last = 0.3f;    // closer than that they are a grey veil
const float ground_min = 0.004f;    // share over the background from which it is drawn

// Smoke on its way through the grid.
const int brick_side = 4;           // texels
// Length of a step, in texels. Against steps of 0.02 the picture of a thin cloud differs by 0.2 of 255
// (root of the mean square, at most 6); half of the length gains 0.07 and costs a third more time.
const float march_step = 0.8f;
const int max_march_steps = 1024;
const float march_opaque = 0.015f;  // rest of the light at which a march ends

// Smoke over surfaces.
const float smoke_hides = 0.999f;    // opacity that hides everything behind it
const float smoke_falloff = 9.0f;    // up to a third of the spacing a distance hardly counts
const float smoke_forward = 0.5f;    // of the phase function by Henyey and Greenstein
const float smoke_direct = 1.75f;
const float smoke_direct_phase = 0.35f;
const float smoke_inside = 0.30f;
const float smoke_inside_phase = 0.2f;
const float smoke_inside_sky = 0.75f;  // share of the sky's colour, the rest is the sun's
const float smoke_sky = 0.72f;
const float smoke_bounce = 0.42f;
