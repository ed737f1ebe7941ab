// Goes after constants.glsl.

// Same for the same sample of every picture: breaks up the bands of dark gradients.
float noise(uvec2 at) {
  uint h = at.x * noise_column ^ at.y * noise_row;
  h = (h ^ (h >> 15)) * noise_mix_1;
  h = (h ^ (h >> 12)) * noise_mix_2;
  return float((h ^ (h >> 15)) >> 8) / 16777216.0;
}

// As even as it gets over every few neighbours, so that a small blur takes it away (J. Jimenez, Next
// generation post processing in Call of Duty: Advanced Warfare, 2014).
float even_noise(vec2 at) {
  return fract(even_noise_scale * fract(dot(at, vec2(even_noise_column, even_noise_row))));
}
