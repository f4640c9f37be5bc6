// The listing's step, to be read beside the paper. Whole expressions are kept as they stand there:
// C++ evaluates a + b + c and f * d / r from left to right as FORTRAN does.
//
// No fused multiply-add, whatever the flags: the project's -ffp-contract=off covers this file; the
// pragma below covers builds that lack it or say -ffp-contract=fast (GCC ignores the standard's
// #pragma STDC FP_CONTRACT in C++). It does not undo -ffast-math.
//
// Variants for the benchmark: compile this file once more with -DBOUNCE_LISTING_VARIANT=name (the
// namespace of run_listing, beside `exact`) and, if the compiler may contract,
// -DBOUNCE_LISTING_MAY_CONTRACT. Declare bounce::name::run_listing and hand it to Oracle.
#include "verify/oracle/listing.hpp"

#ifndef BOUNCE_LISTING_VARIANT
#define BOUNCE_LISTING_VARIANT exact
#endif

#ifndef BOUNCE_LISTING_MAY_CONTRACT
#if defined(__clang__)
#pragma clang fp contract(off)
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#endif
#endif

namespace bounce::BOUNCE_LISTING_VARIANT {

namespace {

struct Force {
  double x, y;
};

// Rkk, Fk, FXk and FYk: the force of particle j on particle i.
inline Force local(const Listing& b, int i, int j, double h) {
  const double r = (b.x[i] - b.x[j]) * (b.x[i] - b.x[j]) + (b.y[i] - b.y[j]) * (b.y[i] - b.y[j]);
  const double f = (-b.e + h / r) / r;
  return {f * (b.x[i] - b.x[j]) / r, f * (b.y[i] - b.y[j]) / r};
}

// "Since all masses are unity, ACX = FX, etc."
inline void add(Listing& b, int i, Force f1, Force f2, Force f3, Force f4) {
  b.acx[i] = f1.x + f2.x + f3.x + f4.x;
  b.acy[i] = f1.y + f2.y + f3.y + f4.y;
}

inline void add(Listing& b, int i, Force f1, Force f2, Force f3, Force f4, Force f5, Force f6) {
  b.acx[i] = f1.x + f2.x + f3.x + f4.x + f5.x + f6.x;
  b.acy[i] = f1.y + f2.y + f3.y + f4.y + f5.y + f6.y;
}

// Labels 701 to 77: the nine cases.
void local_forces(Listing& b) {
  for (int i = 1; i <= 360; ++i) {
    if (i == 1) {  // 7001
      add(b, 1, local(b, 1, 2, b.h11), local(b, 1, 120, b.h11), local(b, 1, 121, b.h12),
          local(b, 1, 240, b.h12));
    } else if (i <= 119) {  // 7002
      add(b, i, local(b, i, i + 1, b.h11), local(b, i, i - 1, b.h11), local(b, i, i + 120, b.h12),
          local(b, i, i + 119, b.h12));
    } else if (i == 120) {  // 7003
      add(b, 120, local(b, 120, 1, b.h11), local(b, 120, 119, b.h11), local(b, 120, 240, b.h12),
          local(b, 120, 239, b.h12));
    } else if (i == 121) {  // 7004
      add(b, 121, local(b, 121, 1, b.h12), local(b, 121, 2, b.h12), local(b, 121, 122, b.h22),
          local(b, 121, 240, b.h22), local(b, 121, 242, b.h23), local(b, 121, 241, b.h23));
    } else if (i <= 239) {  // 7005
      add(b, i, local(b, i, i - 120, b.h12), local(b, i, i - 119, b.h12), local(b, i, i + 1, b.h22),
          local(b, i, i - 1, b.h22), local(b, i, i + 120, b.h23), local(b, i, i + 121, b.h23));
    } else if (i == 240) {  // 7006
      add(b, 240, local(b, 240, 120, b.h12), local(b, 240, 1, b.h12), local(b, 240, 121, b.h22),
          local(b, 240, 239, b.h22), local(b, 240, 360, b.h23), local(b, 240, 241, b.h23));
    } else if (i == 241) {  // 7007
      add(b, 241, local(b, 241, 242, b.h33), local(b, 241, 360, b.h33), local(b, 241, 121, b.h23),
          local(b, 241, 240, b.h23));
    } else if (i <= 359) {  // 7008
      add(b, i, local(b, i, i + 1, b.h33), local(b, i, i - 1, b.h33), local(b, i, i - 120, b.h23),
          local(b, i, i - 121, b.h23));
    } else {  // 7009
      add(b, 360, local(b, 360, 359, b.h33), local(b, 360, 241, b.h33), local(b, 360, 240, b.h23),
          local(b, 360, 239, b.h23));
    }
  }
}

// "At this point we impose gravity." Adding -g gives the bits of subtracting g.
void impose_gravity(Listing& b) {
  for (int i = 1; i <= 360; ++i) b.acy[i] = b.acy[i] + b.gy;
  if (b.gx == 0.0) return;
  for (int i = 1; i <= 360; ++i) b.acx[i] = b.acx[i] + b.gx;
}

// Label 7123: the drift uses the new velocity.
void move(Listing& b) {
  for (int i = 1; i <= 360; ++i) {
    b.vx[i] = b.vx[i] + b.dt * b.acx[i];
    b.vy[i] = b.vy[i] + b.dt * b.acy[i];
    b.x[i] = b.x[i] + b.dt * b.vx[i];
    b.y[i] = b.y[i] + b.dt * b.vy[i];
  }
}

// Label 995, with the paper's alpha and beta where the listing has zeros written in.
void reflect_on_x_axis(Listing& b, double alpha, double beta) {
  for (int i = 1; i <= 360; ++i) {
    if (b.y[i] > 0.0) continue;
    b.y[i] = -b.y[i];
    b.vx[i] = alpha == 0.0 ? 0.0 : alpha * b.vx[i];
    b.vy[i] = beta == 0.0 ? 0.0 : beta * b.vy[i];
  }
}

// The paper's rule in the axes of another wall (Example 7).
void reflect_on(Listing& b, const Wall& wall) {
  const double nx = wall.normal.x;
  const double ny = wall.normal.y;
  for (int i = 1; i <= 360; ++i) {
    const double d = nx * b.x[i] + ny * b.y[i] - wall.offset;
    if (d > 0.0) continue;
    b.x[i] = b.x[i] - (2.0 * d) * nx;
    b.y[i] = b.y[i] - (2.0 * d) * ny;
    const double vn = nx * b.vx[i] + ny * b.vy[i];
    const double tx = b.vx[i] - vn * nx;
    const double ty = b.vy[i] - vn * ny;
    const double vn_after = wall.beta * vn;
    b.vx[i] = wall.alpha * tx + vn_after * nx;
    b.vy[i] = wall.alpha * ty + vn_after * ny;
  }
}

}  // namespace

void run_listing(Listing& ball, std::span<const Wall> walls, std::int64_t steps) {
  for (std::int64_t k = 0; k < steps; ++k) {
    local_forces(ball);
    impose_gravity(ball);
    move(ball);
    for (const Wall& wall : walls) {
      const bool x_axis = wall.normal.x == 0.0 && wall.normal.y == 1.0 && wall.offset == 0.0;
      if (x_axis) {
        reflect_on_x_axis(ball, wall.alpha, wall.beta);
      } else {
        reflect_on(ball, wall);
      }
    }
  }
}

}  // namespace bounce::BOUNCE_LISTING_VARIANT
