// The listing's files, BALL.DAT and BAL4.OUT: FORMAT (2F12.4, 2F12.4).
#pragma once

#include <iosfwd>

#include "kernels/model/state.hpp"

namespace bounce {

/// Writes x, y (cm), vx, vy (cm/s), one particle a line, as gfortran prints 4F12.4: 12 columns
/// each, four decimals, asterisks for a number that does not fit.
void write_listing_frame(std::ostream& out, const State& state);

/// Reads such a file, in columns of 12 or separated by blanks; blank lines may follow at the end.
/// A number without a point is what it says (FORTRAN's F12.4 would divide it by 10^4; the listing
/// never writes one). Throws std::runtime_error naming the line for anything but four finite
/// numbers a line, and for a file without any.
State read_listing_frame(std::istream& in);

}  // namespace bounce
