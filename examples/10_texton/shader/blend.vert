#version 300 es
// Passes on what blend.frag needs. Nothing here is special: positions in the world, UVs of four maps, corner weights.
precision highp float;

uniform mat4 to_world, to_clip;  // to_clip: from the world
uniform mat3 normal_to_world;

in vec3 POSITION, NORMAL;
in vec4 TANGENT;
in vec2 TEXCOORD_0, _UV_A, _UV_B, _UV_C;
in vec3 _BARY, _BLEND;

out vec3 place, normal, corner;
out vec4 tangent;
out vec2 uv, uv_a, uv_b, uv_c;
flat out vec3 gain;  // E_t d of the edges opposite to the three corners, alike at all of them

void main() {
  vec4 at = to_world * vec4(POSITION, 1.0);
  place = at.xyz;
  normal = normal_to_world * NORMAL;
  tangent = vec4(normalize(mat3(to_world) * TANGENT.xyz), TANGENT.w);
  uv = TEXCOORD_0;
  uv_a = _UV_A;
  uv_b = _UV_B;
  uv_c = _UV_C;
  corner = _BARY;
  gain = _BLEND;
  gl_Position = to_clip * at;
}
