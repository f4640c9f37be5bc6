// The ledgers of a run: energy, momentum and angular momentum since its start, split into what the
// walls did and what the integrator did, and checked to close to rounding.
//
// Cheap form, from the samples alone. The momentum that gravity does not explain in an interval
// between two samples is the walls' impulse. An interval is
//  - free, if nothing could reach a wall in it, or the momentum closes to rounding: momentum and
//    angular momentum must close, and the change of the modified energy (inspection.hpp) is the
//    integrator's;
//  - in contact, if not: the changes of modified energy and angular momentum are booked to the
//    walls, approximately: what the integrator did meanwhile is among them. So is an interval at
//    whose ends a particle was so near to a wall that a drift held over (method.hpp) may have
//    mirrored it on the copy that was read out.
//
// Full form, with the books of a BookingStepper: every reflection is booked, so all ledgers close
// over the whole run, contact and all, and drift is what the integrator itself did.
//
// In both: change of energy = walls + swing + drift. Swing comes and goes with the motion (modified
// energy less energy, between start and now); drift is what remains. While particles are pressed to
// a wall, each step moves them into it by F dt^2 and the reflection moves them out: the integrator
// drifts by an amount of order dt there, which halves with the step, and the full form shows it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "kernels/model/problem.hpp"
#include "verify/watch/compensated_sum.hpp"
#include "verify/watch/inspection.hpp"
#include "verify/watch/monitor.hpp"
#include "verify/watch/rounding_size.hpp"
#include "verify/watch/wall_books.hpp"

namespace bounce {

/// One balance: what is left over, and what is allowed.
struct LedgerLine {
  std::string name;       ///< "momentum x", ...
  std::string unit;       ///< cgs, unit masses
  double residual = 0.0;  ///< left over
  double likely = 0.0;    ///< what independent roundings explain, one standard deviation
  double allowed = 0.0;   ///< what roundings of one sign, and terms left out, explain at most
  std::int64_t fault_step = -1;  ///< of the sample at which it first did not close; -1: it closes

  [[nodiscard]] bool closes() const { return fault_step < 0; }

  template <class Words>
  void serialize(Words& words) {  // name and unit are its place's
    words(residual, likely, allowed, fault_step);
  }
};

/// What the ledgers say of a run so far. Energies are erg, since the start.
struct LedgerReport {
  bool full = false;  ///< every reflection is booked
  double change = 0.0;
  double walls = 0.0;  ///< energy that the ball got from the walls; negative: lost to them
  double swing = 0.0;
  double drift = 0.0;
  double greatest_swing = 0.0;  ///< largest |modified energy less energy| of a sample
  double free_share = 0.0;      ///< part of the steps that lie in intervals without contact
  Vec2 impulse;                 ///< of the walls, cm/s
  double torque = 0.0;          ///< of the walls, about the centre of mass, cm^2/s
  std::vector<LedgerLine> lines;
  std::vector<WallBook> books;  ///< one a wall; full form only
  std::int64_t missed = 0;      ///< of the books
  std::int64_t otherwise = 0;   ///< of the books

  [[nodiscard]] bool closes() const;
};

/// One interval between two samples.
struct LedgerInterval {
  bool contact = false;                             ///< a wall acted
  std::int64_t reflections = 0;                     ///< full form only
  Vec2 impulse;                                     ///< of the walls
  double torque = 0.0;                              ///< of the walls
  double kinetic = 0.0, gravity = 0.0, bond = 0.0;  ///< from the walls; full form only
  double walls = 0.0;                               ///< energy from the walls
  double swing = 0.0, drift = 0.0;
  Vec2 momentum_residual;
  double angular_residual = 0.0;

  template <class Words>
  void serialize(Words& words) {
    words(contact, reflections, impulse.x, impulse.y, torque, kinetic, gravity, bond, walls, swing,
          drift, momentum_residual.x, momentum_residual.y, angular_residual);
  }
};

class Ledger {
 public:
  /// `full`: add() will be given books.
  explicit Ledger(const Model& model, bool full = false);

  /// The next sample; the first is the start. `sample` is measure()'s of `state`; `books` those of
  /// the stepper at this step. Throws std::invalid_argument for a step that is not after the last
  /// one, or for missing books in the full form.
  void add(std::int64_t step, const State& state, const Sample& sample,
           const WallBooks* books = nullptr);

  /// The interval that ended with the last sample.
  [[nodiscard]] const LedgerInterval& last() const { return interval_; }
  [[nodiscard]] LedgerReport report() const;

  template <class Words>
  void serialize(Words& words) {
    words(start_, before_, interval_, momentum_x_, momentum_y_, angular_, stretch_, free_energy_,
          behind_, walls_, impulse_x_, impulse_y_, torque_, free_steps_, greatest_swing_,
          booked_fault_);
  }

 private:
  struct Look {
    std::int64_t step = 0;
    Sample sample;
    Inspection inspection;
    WallBooks books;
    [[nodiscard]] double modified() const { return sample.total() + inspection.swing; }
    template <class Words>
    void serialize(Words& words) {
      words(step, sample, inspection, books);
    }
  };
  struct Balance {
    CompensatedSum residual;
    RoundingSize rounding;
    std::int64_t fault_step = -1;
    template <class Words>
    void serialize(Words& words) {
      words(residual, rounding, fault_step);
    }
  };
  // Intervals without contact, in a row. The one nearest to its allowance is reported.
  struct Stretch {
    double start = 0.0;  // modified energy
    RoundingSize steps;  // roundings since
    double left_out = 0.0;
    template <class Words>
    void serialize(Words& words) {
      words(start, steps, left_out);
    }
  };

  void measure_walls(const Look& now);
  static void close(Balance& balance, double left_over, const RoundingSize& explained,
                    std::int64_t step);
  void close_momentum(const Look& now);
  void close_energy(const Look& now);
  void check_stretch(const Look& now);
  void check_walls(const Look& now);
  void begin_stretch(const Look& now);
  [[nodiscard]] Vec2 beyond_gravity(const Look& now) const;
  [[nodiscard]] RoundingSize rounding_x(const Look& now) const;
  [[nodiscard]] RoundingSize rounding_y(const Look& now) const;
  [[nodiscard]] double steps_to(const Look& now) const;

  Model model_;
  bool full_;
  double held_drift_;  // of the stage held over between two steps, s
  std::optional<Look> start_, before_;
  LedgerInterval interval_;
  Balance momentum_x_, momentum_y_, angular_;
  Stretch stretch_;
  LedgerLine free_energy_, behind_;
  CompensatedSum walls_, impulse_x_, impulse_y_, torque_, free_steps_;
  double greatest_swing_ = 0.0;
  std::int64_t booked_fault_ = -1;
};

}  // namespace bounce
