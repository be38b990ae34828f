#pragma once
/// Gaussian: an ellipsoid as 3D Gaussian splatting stores it [Kerbl, Kopanas, Leimkuehler, Drettakis: 3D Gaussian
/// Splatting for Real-Time Radiance Field Rendering, 2023, section 4], and what a map does to it.
///
///   S  = R diag(exp(2 s)) R^T        covariance, length^2 (eq. 6)
///   S' = J S J^T                     under a map with derivative J; exact for a map that is linear about the Gaussian
///
///   R    rotation of the quaternion (w, x, y, z), divided by its norm: files hold norms other than 1
///   s    log-scales: exp(s_k) is the standard deviation along column k of R
///
/// S' is never formed, because flat Gaussians would lose their thickness in it: the columns of J R diag(exp(s)) are
/// turned among themselves until they are orthogonal (one-sided Jacobi), which keeps small ones to full relative
/// accuracy [Demmel and Veselic: Jacobi's method is more accurate than QR, 1992]; they are then the new axes.

#include "engine/geometry/shape.h"

namespace sinew {

struct Gaussian {
  Eigen::Vector4d quaternion;  ///< w, x, y, z, of any norm but 0
  Vec3 log_scales;             ///< of the file's unit of length; -infinity is a flat Gaussian
};

Mat3 covariance(const Gaussian& gaussian);

/// Under a map with derivative J, whose nearest rotation is Q. Of the 24 frames that describe S', the one nearest to
/// Q R; of both quaternions the one nearest to the old, with its norm. So a rigid motion keeps the log-scales' order,
/// and little changes where J is near the identity.
///
/// An axis shorter than 1e-15 of the longest is flat: it is the normal of the others, and has the lower of its former
/// log-scale and that limit. Where the quaternion is 0 or not finite, a log-scale is NaN or +infinity, or J is not
/// finite or 0 on the Gaussian, there is no ellipsoid to bend: the Gaussian is given back as it was.
Gaussian bent(const Gaussian& gaussian, const Mat3& J, const Mat3& Q);

}  // namespace sinew
