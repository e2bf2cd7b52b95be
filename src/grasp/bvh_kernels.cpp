#include "grasp/bvh_kernels.hpp"

#define GFP_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))

namespace gfp {
namespace {

inline double least(double a, double b) { return a < b ? a : b; }
inline double most(double a, double b) { return a > b ? a : b; }
inline double magnitude(double a) { return a < 0 ? -a : a; }

}  // namespace

GFP_CLONES void ray_to_boxes(const TriangleBvh::Node& node, const double* origin, const double* inverse, double* entry) {
  double near[4] = {0, 0, 0, 0}, far[4] = {1e300, 1e300, 1e300, 1e300};
  for (int axis = 0; axis < 3; ++axis) {
    const double o = origin[axis], r = inverse[axis];
    for (int i = 0; i < 4; ++i) {
      const double t0 = (node.centre[axis][i] - node.extent[axis][i] - o) * r, t1 = (node.centre[axis][i] + node.extent[axis][i] - o) * r;
      near[i] = most(near[i], least(t0, t1));
      far[i] = least(far[i], most(t0, t1));
    }
  }
  for (int i = 0; i < 4; ++i) entry[i] = near[i] <= far[i] ? near[i] : 1e300;
}

GFP_CLONES void ray_to_triangles(const TriangleBvh::Leaf& leaf, const double* origin, const double* direction, double* distance, double* determinant) {
  const double dx = direction[0], dy = direction[1], dz = direction[2], ox = origin[0], oy = origin[1], oz = origin[2];
  for (int i = 0; i < 4; ++i) {
    const double ax = leaf.edge1[0][i], ay = leaf.edge1[1][i], az = leaf.edge1[2][i];
    const double bx = leaf.edge2[0][i], by = leaf.edge2[1][i], bz = leaf.edge2[2][i];
    const double px = dy * bz - dz * by, py = dz * bx - dx * bz, pz = dx * by - dy * bx;
    const double det = ax * px + ay * py + az * pz, inverse = 1.0 / det;  // infinite along the plane: u is then NaN or infinite
    const double sx = ox - leaf.corner[0][i], sy = oy - leaf.corner[1][i], sz = oz - leaf.corner[2][i];
    const double u = (sx * px + sy * py + sz * pz) * inverse;
    const double qx = sy * az - sz * ay, qy = sz * ax - sx * az, qz = sx * ay - sy * ax;
    const double v = (dx * qx + dy * qy + dz * qz) * inverse, t = (bx * qx + by * qy + bz * qz) * inverse;
    const bool inside = (u >= 0) & (v >= 0) & (u + v <= 1);
    distance[i] = inside ? t : -1.0;
    determinant[i] = det;
  }
}

GFP_CLONES void box_to_boxes(const TriangleBvh::Node& node, const double* rotation, const double* translation, const double* half, double* squared) {
  for (int i = 0; i < 4; ++i) squared[i] = 0;
  for (int row = 0; row < 3; ++row) {
    const double rx = rotation[3 * row], ry = rotation[3 * row + 1], rz = rotation[3 * row + 2], t = translation[row], h = half[row];
    const double mx = magnitude(rx), my = magnitude(ry), mz = magnitude(rz);
    for (int i = 0; i < 4; ++i) {
      const double centre = rx * node.centre[0][i] + ry * node.centre[1][i] + rz * node.centre[2][i] + t;
      const double reach = mx * node.extent[0][i] + my * node.extent[1][i] + mz * node.extent[2][i] + h;
      const double gap = most(magnitude(centre) - reach, 0.0);
      squared[i] += gap * gap;
    }
  }
}

GFP_CLONES void corners_in_box(const TriangleBvh::Leaf& leaf, const double* rotation, const double* translation, double (*corners)[3][4]) {
  for (int row = 0; row < 3; ++row) {
    const double rx = rotation[3 * row], ry = rotation[3 * row + 1], rz = rotation[3 * row + 2], t = translation[row];
    for (int i = 0; i < 4; ++i) {
      const double first = rx * leaf.corner[0][i] + ry * leaf.corner[1][i] + rz * leaf.corner[2][i] + t;
      corners[0][row][i] = first;
      corners[1][row][i] = first + (rx * leaf.edge1[0][i] + ry * leaf.edge1[1][i] + rz * leaf.edge1[2][i]);
      corners[2][row][i] = first + (rx * leaf.edge2[0][i] + ry * leaf.edge2[1][i] + rz * leaf.edge2[2][i]);
    }
  }
}

}  // namespace gfp
