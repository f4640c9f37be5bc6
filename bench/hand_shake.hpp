// How far two cores are from each other: what threads on one ball are held against.
#pragma once

namespace bounce {

/// Seconds from one thread to another and back, through a word of memory each, in the mean of a
/// thousand; measured now, in less than a millisecond.
double hand_shake_time();

}  // namespace bounce
