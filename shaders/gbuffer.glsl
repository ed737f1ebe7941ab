// Data from the drawing passes to the shading pass, one texel per sample: unit normal in world axes
// and the kind of surface (constants.glsl); albedo as its square root, which spends 8 bits where the
// eye sees steps, and in alpha how much of the surface is left over the background.

layout(location = 0) out vec4 out_normal_kind;
layout(location = 1) out vec4 out_albedo;
