// One step of the paper's listing: what oracle.cpp runs. Its own file, because the benchmark
// compiles it again with other flags (see BOUNCE_LISTING_VARIANT).
#pragma once

#include <cstdint>
#include <span>

#include "kernels/model/scene.hpp"

namespace bounce {

/// The listing's variables, under its names and with its indices: 1 to 360, element 0 unused. Its
/// second index (old and new step) is not needed: nothing reads an old value once the new one
/// stands.
struct Listing {
  double x[361] = {}, y[361] = {}, vx[361] = {}, vy[361] = {};  ///< cm, cm/s
  double acx[361] = {}, acy[361] = {};                          ///< cm/s^2
  double e = 0.0;    ///< constant of elasticity, 16000. in the listing
  double h11 = 0.0;  ///< E R0^2 for two particles of ring 1, 1096.64
  double h12 = 0.0;  ///< rings 1 and 2, 16328.
  double h22 = 0.0;  ///< ring 2, 1578.4
  double h23 = 0.0;  ///< rings 2 and 3, 16462.8
  double h33 = 0.0;  ///< ring 3, 2148.8
  double gx = 0.0;   ///< cm/s^2, nothing is added if it is zero
  double gy = 0.0;   ///< cm/s^2, -.098 in the listing
  double dt = 0.0;   ///< s, 0.000001 in the listing
};

/// What runs a Listing: run_listing of one of the variants.
using RunListing = void (*)(Listing& ball, std::span<const Wall> walls, std::int64_t steps);

/// The oracle's own variant: no fused multiply-add, whatever the flags.
namespace exact {

/// Takes `steps` steps of the listing: forces in its order, gravity, v += dt a, x += dt v, walls.
///
/// Walls are applied one after another, in the scene's order. Operations from left to right:
/// - the X axis (normal exactly (0, 1), offset 0), if not y > 0:
///     y = -y; vx = alpha == 0 ? 0 : alpha*vx; vy = beta == 0 ? 0 : beta*vy
///   (for alpha = beta = 0 the listing's own three statements);
/// - any other wall, the paper's rule in the wall's own axes:
///     d = nx*x + ny*y - offset; if not d > 0:
///     x = x - (2*d)*nx; y = y - (2*d)*ny; vn = nx*vx + ny*vy; tx = vx - vn*nx; ty = vy - vn*ny;
///     vn = beta*vn; vx = alpha*tx + vn*nx; vy = alpha*ty + vn*ny
/// The kernel `strict` does the same operations, so that it gives the same bits.
void run_listing(Listing& ball, std::span<const Wall> walls, std::int64_t steps);

}  // namespace exact
}  // namespace bounce
