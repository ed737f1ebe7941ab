// Colours of the light that falls on things, linear.

const vec3 sun = vec3(1.30, 1.22, 1.08);
const vec3 sky = vec3(0.42, 0.56, 0.80);
const vec3 bounce = vec3(0.23, 0.29, 0.38);
const vec3 scatter = vec3(0.10, 0.16, 0.24);
