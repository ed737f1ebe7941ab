// Smooths edges of a picture that has one sample for each pixel, where its neighbours differ by more
// than snow's grain does: the edge is followed to its ends, and the pixel takes from the other side
// what a straight edge between them would cover (Lottes, FXAA, 2009). In: the shaded samples, sRGB,
// premultiplied by alpha. Out: the same. Writes no depth.

uniform sampler2D samples;

out vec4 out_color;

// Contrast from which there is an edge: of the brightest neighbour, and at least.
const float edge_share = 0.16, edge_min = 0.04;
const int longest = 12;  // pixels that an edge is followed to either side

float brightness(vec4 color) { return dot(color.rgb, vec3(0.299, 0.587, 0.114)); }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(samples, 0) - 1;
  vec4 color = texelFetch(samples, at, 0);
  out_color = color;
  // Right, left, above and below.
  ivec2 r = min(at + ivec2(1, 0), last), l = max(at - ivec2(1, 0), ivec2(0));
  ivec2 t = min(at + ivec2(0, 1), last), b = max(at - ivec2(0, 1), ivec2(0));
  float m = brightness(color), mr = brightness(texelFetch(samples, r, 0)),
        ml = brightness(texelFetch(samples, l, 0)), mt = brightness(texelFetch(samples, t, 0)),
        mb = brightness(texelFetch(samples, b, 0));
  float most = max(m, max(max(mr, ml), max(mt, mb))), least = min(m, min(min(mr, ml), min(mt, mb)));
  float contrast = most - least;
  if (contrast < max(edge_min, edge_share * most)) return;

  // The edge runs along the axis across which brightness bends least.
  float mtr = brightness(texelFetch(samples, ivec2(r.x, t.y), 0)),
        mtl = brightness(texelFetch(samples, ivec2(l.x, t.y), 0)),
        mbr = brightness(texelFetch(samples, ivec2(r.x, b.y), 0)),
        mbl = brightness(texelFetch(samples, ivec2(l.x, b.y), 0));
  float bends_up = 2.0 * abs(mt + mb - 2.0 * m) + abs(mtl + mbl - 2.0 * ml) + abs(mtr + mbr - 2.0 * mr);
  float bends_aside =
      2.0 * abs(mr + ml - 2.0 * m) + abs(mtr + mtl - 2.0 * mt) + abs(mbr + mbl - 2.0 * mb);
  bool is_level = bends_up >= bends_aside;
  ivec2 along = is_level ? ivec2(1, 0) : ivec2(0, 1), across = ivec2(1) - along;
  float ahead = is_level ? mt : mr, behind = is_level ? mb : ml;
  bool is_ahead = abs(ahead - m) >= abs(behind - m);
  ivec2 other = is_ahead ? across : -across;
  float step_up = (is_ahead ? ahead : behind) - m;
  // An edge that is too weak beside another one of this pixel is not followed.
  if (abs(step_up) < 0.5 * contrast) return;

  // To either side, while the two rows differ as here.
  float found[2];
  bool is_end[2];
  for (int side = 0; side < 2; ++side) {
    found[side] = float(longest);
    is_end[side] = false;
    for (int k = 1; k <= longest; ++k) {
      ivec2 here = clamp(at + (side == 0 ? -k : k) * along, ivec2(0), last);
      ivec2 there = clamp(here + other, ivec2(0), last);
      float own = brightness(texelFetch(samples, here, 0)),
            its = brightness(texelFetch(samples, there, 0));
      if (abs(its - own - step_up) < 0.5 * abs(step_up)) continue;
      found[side] = float(k);
      // This row takes the other side's brightness: the edge steps towards this pixel there.
      is_end[side] = abs(own - m) > 0.5 * abs(step_up);
      break;
    }
  }
  int near = found[0] <= found[1] ? 0 : 1;
  if (!is_end[near]) return;
  float whole = found[0] + found[1] - 1.0;
  float share = max(0.5 - (found[near] - 0.5) / whole, 0.0);
  ivec2 across_at = clamp(at + other, ivec2(0), last);
  out_color = mix(color, texelFetch(samples, across_at, 0), share);
}
