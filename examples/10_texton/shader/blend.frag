#version 300 es
// A face in its own map of the sample and, over the edges that show from here, in its neighbours'.
// Magda & Kriegman 2003, section 3.3: an edge is blended where PHI = lambda E_t d / |v - m| exceeds a threshold.
precision highp float;

uniform vec3 viewer;      // v, in the world
uniform float lambda;     // pixels across the field of view / its angle in radians
uniform float threshold;  // of PHI: differences of 255 times pixels; 150 hides what would show, 0 blends all
uniform vec3 light;       // unit, towards it
uniform int show;         // 0: the surface, 1: which edges are blended
uniform sampler2D base_colour, normals;
uniform bool has_normals;

in vec3 place, normal, corner;
in vec4 tangent;
in vec2 uv, uv_a, uv_b, uv_c;
flat in vec3 gain;
out vec4 colour;

const float REACH = 0.5;  // of the face's height, from an edge inwards, over which the neighbour fades out

// Middle of the edge opposite to corner k. Places are linear in corner weights over the face, so their differences to
// the next pixel to the right and below give the two edge vectors at corner 2, exactly, and those every place.
vec3 middle(int k, vec3 dx, vec3 dy, vec3 bx, vec3 by) {
  float area = bx.x * by.y - bx.y * by.x;
  if (area == 0.0) return place;  // no differences to be had: this pixel is as good a place as any
  vec3 from_2_to_0 = (dx * by.y - dy * bx.y) / area;
  vec3 from_2_to_1 = (dy * bx.x - dx * by.x) / area;
  vec3 way = vec3(0.5) - corner;
  way[k] = -corner[k];
  return place + way.x * from_2_to_0 + way.y * from_2_to_1;
}

// A neighbour's share beside 1 for the own map: 1 on its edge, 0 on the other two edges, smooth between.
float share(float own, float second, float third) {
  float x = min(own / REACH, 1.0);
  return (1.0 - x * x * (3.0 - 2.0 * x)) * second * third / max((own + second) * (own + third), 1e-12);
}

// The sample's normal n read in a map, turned into the face's own; both see one step on the screen, in texels.
vec3 turned(vec3 n, vec2 ours, vec2 theirs) {
  vec2 turn = vec2(dot(ours, theirs), ours.x * theirs.y - ours.y * theirs.x);
  turn /= max(length(turn), 1e-20);  // (cosine, sine) of the map against the own, rows down; normals have y up
  return vec3(turn.x * n.x - turn.y * n.y, turn.y * n.x + turn.x * n.y, n.z);
}

void main() {
  vec3 dx = dFdx(place), dy = dFdy(place), bx = dFdx(corner), by = dFdy(corner);
  vec2 maps[4] = vec2[4](uv, uv_a, uv_b, uv_c);
  vec2 map_dx[4] = vec2[4](dFdx(uv), dFdx(uv_a), dFdx(uv_b), dFdx(uv_c));
  vec2 map_dy[4] = vec2[4](dFdy(uv), dFdy(uv_a), dFdy(uv_b), dFdy(uv_c));
  vec2 size = vec2(textureSize(base_colour, 0));

  float weights[4] = float[4](1.0, 0.0, 0.0, 0.0);
  float total = 1.0;
  vec3 at = max(corner, 0.0);  // on the outline a pixel's centre may lie outside the face
  for (int k = 0; k < 3; ++k) {
    float phi = lambda * gain[k] / distance(viewer, middle(k, dx, dy, bx, by));
    if (gain[k] > 0.0 && phi > threshold) weights[k + 1] = share(at[k], at[(k + 1) % 3], at[(k + 2) % 3]);
    total += weights[k + 1];
  }

  vec3 albedo = vec3(0.0), bump = vec3(0.0, 0.0, has_normals ? 0.0 : 1.0);
  for (int k = 0; k < 4; ++k) {
    if (weights[k] == 0.0) continue;
    float w = weights[k] / total;
    albedo += w * textureGrad(base_colour, maps[k], map_dx[k], map_dy[k]).rgb;
    vec3 n = 2.0 * textureGrad(normals, maps[k], map_dx[k], map_dy[k]).xyz - 1.0;
    if (has_normals) bump += w * turned(n, size * map_dx[0], size * map_dx[k]);
  }

  vec3 n = normalize(dot(normal, normal) > 0.0 ? normal : cross(dx, dy));  // flat where the file has no normals
  vec3 t = tangent.xyz, b = tangent.w * cross(n, t);
  n = normalize(bump.x * t + bump.y * b + bump.z * n);
  if (show == 1) albedo = mix(vec3(0.05), vec3(0.95, 0.35, 0.05), 1.0 - 1.0 / total);
  vec3 lit = albedo * (0.28 + 0.12 * n.y + 0.85 * max(dot(n, light), 0.0));
  colour = vec4(pow(lit, vec3(1.0 / 2.2)), 1.0);
}
