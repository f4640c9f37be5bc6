// Scenes that several tests of the kernels share, and the request for a kernel.
#pragma once

#include <cmath>
#include <string>

#include "kernels/model/scene.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/tests/paper_scenes.hpp"

namespace bounce {

/// Example 2's ball just above the floor and falling fast: it touches within some thousand steps.
inline Scene touching_scene() {
  Scene scene;
  scene.ball.centre.y = 7.002;
  scene.ball.velocity = {0.5, -2.0};
  scene.walls = {Wall{}};
  return scene;
}

inline Scene wedge_scene() {
  Scene scene = touching_scene();
  const double h = std::sqrt(0.5);
  scene.walls = {Wall{{h, h}, -2.051, 0.3, -0.7}, Wall{{0.0, 1.0}, 0.0, 1.0, -1.0}};
  return scene;
}

/// The same thrown up against a ceiling, over a floor that it does not touch.
inline Scene ceiling_scene() {
  Scene scene = touching_scene();
  scene.ball.velocity.y = 2.0;
  scene.walls = {Wall{}, Wall{{0.0, -1.0}, -(7.002 + 7.002), 0.4, -0.6}};
  return scene;
}

/// A scene with resolved contact, sticky unless said otherwise.
inline Scene resolved(Scene scene, double alpha = 0.0, double beta = 0.0) {
  for (Wall& wall : scene.walls) {
    wall.contact = Contact::resolved;
    wall.alpha = alpha;
    wall.beta = beta;
  }
  return scene;
}

inline Scene law_scene(double p, double q) {
  Scene scene = touching_scene();
  scene.law.p = p;
  scene.law.q = q;
  scene.law.rest = Rest::geometry;
  return scene;
}

/// Neighbours as far apart as on ring 1 of the paper's ball.
inline Scene touching_disc_scene() {
  Scene scene = touching_scene();
  scene.ball.kind = BallKind::disc;
  scene.ball.radii = {2.0};
  scene.ball.spacing = 0.25;
  scene.ball.centre.y = 1.997;
  scene.law.rest = Rest::geometry;
  return scene;
}

/// A disc in the place of example 2's ball.
inline Scene disc_scene(double radius, double spacing) {
  Scene scene = paper_scene(2);
  scene.ball.kind = BallKind::disc;
  scene.ball.radii = {radius};
  scene.ball.spacing = spacing;
  scene.ball.rounding = Rounding::none;
  scene.law.rest = Rest::geometry;
  return scene;
}

/// That kernel and no other, on as many threads whatever this machine has.
inline PlanRequest forced(const std::string& kernel, int threads = 1) {
  PlanRequest request;
  request.kernel = kernel;
  request.threads = threads;
  request.more_threads_than_cores = true;
  return request;
}

}  // namespace bounce
