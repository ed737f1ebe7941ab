// Mean of the 2x2 samples of a pixel, after tone mapping: bright snow then does not eat the edge
// against a dark background. In: the shaded samples. Out: sRGB, premultiplied by alpha.
// Writes no depth.

uniform sampler2D samples;

out vec4 out_color;

void main() {
  ivec2 at = 2 * ivec2(gl_FragCoord.xy);
  out_color = 0.25 * (texelFetch(samples, at, 0) + texelFetch(samples, at + ivec2(1, 0), 0) +
                      texelFetch(samples, at + ivec2(0, 1), 0) +
                      texelFetch(samples, at + ivec2(1, 1), 0));
}
