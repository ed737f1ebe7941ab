// Colour times the coverage stored in the font texture; blended over the picture. Writes no depth.

in vec2 texture_position;
in vec4 color;

uniform sampler2D font;

out vec4 out_color;

void main() { out_color = color * texture(font, texture_position); }
