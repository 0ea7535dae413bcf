// The source of a pixel in an image that another eye drew: runtime/math/reprojection.h.

// Enough for a pixel where depth is smooth. At edges, what the other eye did not see has no
// source: there the turns end with one that is near.
const int kTurns = 6;

vec2 image_size() {
  return vec2(textureSize(color_image, 0).xy);
}

// Beyond the image its edge goes on.
ivec2 nearest_pixel(vec2 at) {
  return ivec2(clamp(floor(at), vec2(0.0), image_size() - 1.0));
}

// 1/z now of what the image shows at a pixel.
float inverse_z_now(ivec2 pixel) {
  const float inverse_z = inverse_depth(pixel);
  const vec3 seen = vec3(push.drawn.xy + (vec2(pixel) + 0.5) / image_size() * push.drawn.zw, 1.0);
  const vec3 apart = vec3(push.rows[0].w, push.rows[1].w, push.rows[2].w);
  const vec3 forward = vec3(push.rows[0].z, push.rows[1].z, push.rows[2].z);
  const float share = dot(forward, seen - apart * inverse_z);
  return share > 0.0 ? inverse_z / share : 0.0;
}

Source reprojected() {
  const vec2 share = pixel_center() / image_size();
  const vec3 seen = vec3(push.now.xy + share * push.now.zw, 1.0);
  Source source = Source(vec2(0.0), 0.0);
  for (int turn = 0; turn < kTurns; ++turn) {
    const vec4 from = vec4(seen, source.inverse_z);
    const vec3 drawn = vec3(dot(push.rows[0], from), dot(push.rows[1], from), dot(push.rows[2], from));
    // Behind the eye that drew there is nothing: the place of the turn before stays.
    if (drawn.z <= 0.0) break;
    source.at = (drawn.xy / drawn.z - push.drawn.xy) / push.drawn.zw * image_size();
    source.inverse_z = inverse_z_now(nearest_pixel(source.at));
  }
  return source;
}

// Bilinear. Colours are premultiplied, so that they may be mixed.
vec4 between_pixels(vec2 at) {
  const vec2 low = floor(at - 0.5), share = at - 0.5 - low;
  vec4 sum = vec4(0.0);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      const vec2 weight = mix(1.0 - share, share, vec2(x, y));
      const ivec2 pixel = nearest_pixel(low + vec2(x, y) + 0.5);
      sum += weight.x * weight.y * texelFetch(color_image, ivec3(pixel, push.layer), 0);
    }
  return sum;
}
