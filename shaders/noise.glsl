// Same for the same sample of every picture: breaks up the bands of dark gradients.
float noise(uvec2 at) {
  uint h = at.x * 0x9E3779B1u ^ at.y * 0x85EBCA77u;
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 12)) * 0x297A2D39u;
  return float((h ^ (h >> 15)) >> 8) / 16777216.0;
}

// As even as it gets over every few neighbours, so that a small blur takes it away (J. Jimenez, Next
// generation post processing in Call of Duty: Advanced Warfare, 2014).
float even_noise(vec2 at) { return fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715)))); }
