// Data from the drawing passes to the shading pass, one texel per sample: unit normal in world axes
// and the kind of surface; albedo as its square root, which spends 8 bits where the eye sees steps,
// and in alpha how much of the surface is left over the background.

layout(location = 0) out vec4 out_normal_kind;
layout(location = 1) out vec4 out_albedo;

const float kind_ground = 1.0;
const float kind_solid = 2.0;
const float kind_snow = 3.0;
const float kind_attribute = 4.0;
const float kind_flat = 5.0;  // shown in its own colour, without light
