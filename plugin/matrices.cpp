// Frusta and poses from the matrices that engines have, column by column.
#include <cmath>
#include <string>

#include "plugin/call.h"
#include "plugin/frustum.h"
#include "plugin/structs.h"
#include "runtime/math/affine.h"

using namespace voyager;

namespace {

constexpr double kRounding = 1e-9;       // of a zero, as matrix products leave it
constexpr double kAxisTolerance = 1e-4;  // of lengths and dot products: of binary32, far from 1
constexpr Mat3d kMirror{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};  // between a left-handed and a right-handed space
enum { kX = 0, kY = 5, kW = 11 };         // the elements that a perspective projection must have
constexpr int kCenterX = 8, kCenterY = 9;

FieldName element(int i) {
  return {"matrix", static_cast<size_t>(i)};
}

void check_matrix(const double* matrix) {
  check_pointer(matrix, "matrix");
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(matrix[i])) refuse_number(element(i), matrix[i], "a finite number");
}

void check_projection(const double* matrix) {
  check_matrix(matrix);
  if (matrix[kW] == 0)
    refuse_number(element(kW), 0, "the factor of z in w: the projection is not a perspective");
  if (!(matrix[kX] > 0))
    refuse_number(element(kX), matrix[kX], "more than 0: the projection mirrors x");
  if (matrix[kY] == 0) refuse_number(element(kY), 0, "the factor of y");
  for (const int i : {1, 3, 4, 7, 12, 13, 15})
    if (std::fabs(matrix[i]) > kRounding * std::fabs(matrix[kW]))
      refuse_number(element(i), matrix[i], "0: the projection is skewed, or moves the eye");
}

// Of a camera whose y points up where `y_up`.
VoyFrustum frustum_of(const double* matrix, bool clip_y_up) {
  const double w = std::fabs(matrix[kW]), ahead = matrix[kW] > 0 ? 1 : -1;
  const auto tangent = [&](double clip, int factor, int center) {
    return (clip * w - ahead * matrix[center]) / matrix[factor];
  };
  const double top = clip_y_up ? 1 : -1;
  const double up = top * matrix[kY] > 0 ? 1 : -1;  // where the camera's own y points
  return {tangent(-1, kX, kCenterX), tangent(1, kX, kCenterX), up * tangent(top, kY, kCenterY),
          up * tangent(-top, kY, kCenterY)};
}

void check_axes(const Affine& affine) {
  const Mat3d axes = transposed(affine.linear);
  for (int i = 0; i < 3; ++i) {
    const std::string axis = "matrix, column " + std::to_string(i);
    const double length = std::sqrt(dot(axes.row[i], axes.row[i]));
    if (!(std::fabs(length - 1) <= kAxisTolerance))
      refuse_number(axis, length, "a length of 1: the matrix scales");
    const double product = dot(axes.row[i], axes.row[(i + 1) % 3]);
    if (!(std::fabs(product) <= kAxisTolerance))
      refuse_number(axis + " times column " + std::to_string((i + 1) % 3), product,
                    "0: the matrix shears");
  }
}

Affine checked_affine(const double* matrix) {
  check_matrix(matrix);
  for (int i = 0; i < 4; ++i)
    if (std::fabs(matrix[4 * i + 3] - (i == 3 ? 1 : 0)) > kRounding)
      refuse_number(element(4 * i + 3), matrix[4 * i + 3], i == 3 ? "1" : "0");
  Affine affine;
  for (int r = 0; r < 3; ++r) affine.linear.row[r] = {matrix[r], matrix[4 + r], matrix[8 + r]};
  affine.offset = {matrix[12], matrix[13], matrix[14]};
  for (int i = 0; i < 3; ++i) check_coordinate(affine.offset[i], element(12 + i));
  check_axes(affine);
  return affine;
}

// The own space is left-handed where it has the hand of such a world, or the other one of another.
VoyPose pose_of(Affine to_world, VoyHand world) {
  const bool left = world == VOY_HAND_LEFT, own_left = left != (determinant(to_world.linear) < 0);
  if (left) to_world = Affine{kMirror} * to_world;
  if (own_left) to_world = to_world * Affine{kMirror};
  const Quatd q = quaternion_of(to_world.linear);
  const Vec3d& p = to_world.offset;
  return {{p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}};
}

}  // namespace

VoyResult VOY_CALL voyFrustumFromProjection(const double* matrix, VoyClipY clipY,
                                            VoyFrustum* frustum) {
  return guarded("voyFrustumFromProjection", [&](Call&) {
    check_pointer(frustum, "frustum");
    check_enum(clipY, VOY_CLIP_Y_DOWN, "clipY");
    check_projection(matrix);
    const VoyFrustum tangents = frustum_of(matrix, clipY == VOY_CLIP_Y_UP);
    check_frustum(tangents, "frustum");
    *frustum = tangents;
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyPoseFromWorldMatrix(const double* matrix, VoyHand worldHand, VoyPose* pose) {
  return guarded("voyPoseFromWorldMatrix", [&](Call&) {
    check_pointer(pose, "pose");
    check_enum(worldHand, VOY_HAND_LEFT, "worldHand");
    *pose = pose_of(checked_affine(matrix), worldHand);
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyPoseFromViewMatrix(const double* matrix, VoyHand worldHand, VoyPose* pose) {
  return guarded("voyPoseFromViewMatrix", [&](Call&) {
    check_pointer(pose, "pose");
    check_enum(worldHand, VOY_HAND_LEFT, "worldHand");
    *pose = pose_of(inverse(checked_affine(matrix)), worldHand);
    return VOY_SUCCESS;
  });
}
