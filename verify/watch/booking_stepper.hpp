// A kernel at work, with every reflection at a wall booked: the full form of the ledgers.
//
// How it is done
//  1. The kernel of the plan stands here twice: for the problem, and for the same problem without
//     walls. Until something is reflected both compute the same bits (a test holds that for every
//     kernel), so a block of steps that ends in the same bits has had no reflection, and one that
//     does not is taken again in shorter blocks. Nothing is assumed about how fast a particle can
//     reach a wall.
//  2. A step with a reflection is taken stage by stage, by kernels of one-stage methods: the state
//     without walls is the one before the reflections, the state with walls the one after. A
//     particle whose bits differ was mirrored. So no wall rule is written again to make the run:
//     its bits are the kernel's own, and a run with books ends in the state of the run without.
//  3. The wall's rule is applied to the state before, to say which wall mirrored a particle,
//     and to see that the kernel did just that (within rounding), no more and no less.
//  4. Particles are booked one after another in their order: a bond's energy changes against the
//     neighbours where they stand at that moment.
//  5. A state that is read out while a stage with a drift is held over (method.hpp) is finished on
//     a copy, by that drift and the walls. The books are those of that state: what the copy's walls
//     did is booked on a copy of the books.
//
// The cost: steps without reflection are taken twice; one with a reflection costs as much as many
// of these, most of it for the energy of the whole ball before and after.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "kernels/model/method.hpp"
#include "kernels/model/problem.hpp"
#include "kernels/stepping/stepper.hpp"
#include "verify/watch/wall_books.hpp"

namespace bounce {

class BookingStepper final : public Stepper {
 public:
  /// Makes the kernel under test for a problem: this one, also without its walls, also with one of
  /// its method's stages as method.
  using Make = std::function<std::unique_ptr<Stepper>(const Problem&)>;

  BookingStepper(Problem problem, Make make);
  ~BookingStepper() override;

  void advance(std::int64_t steps) override;
  [[nodiscard]] State state() const override;
  [[nodiscard]] Snapshot save() const override;
  /// A snapshot saved by a BookingStepper has the books of then; with any other new books begin.
  void restore(const Snapshot& snapshot) override;
  [[nodiscard]] std::int64_t step() const override;

  /// Of state().
  [[nodiscard]] const WallBooks& books() const { return books_; }

 private:
  struct StageKernels;

  void open_books();
  void add_stage(Stage stage, std::vector<std::size_t>& sequence);
  void step_by_stages(const Snapshot& start);
  void book_unfinished();
  void book(double drift, const State& before, const State& after, WallBooks& books) const;
  void look_behind_walls();
  void fault(WallBooks& books) const;

  Problem problem_;
  Make make_;
  std::unique_ptr<Stepper> with_walls_, without_walls_;
  std::vector<std::unique_ptr<StageKernels>> stages_;
  std::vector<std::size_t> fresh_, joined_;  // stages of a step (method.hpp)
  std::int64_t block_ = 1;                   // steps to be taken at a time
  WallBooks done_;                           // of the kernel's own walls
  WallBooks books_;                          // and of those of the copy that is read out
};

}  // namespace bounce
