// Ctrl-C, and the other two signals that ask a program to end, as a flag.
#pragma once

namespace bounce {

/// From now on the first SIGINT (Ctrl-C), SIGTERM or SIGHUP raises a flag; the same one again ends
/// the program as usual. One that the parent set to be ignored (nohup, a shell's background job)
/// stays ignored.
void catch_interrupts();
/// True once one of them has come.
bool interrupted();
/// What the program then exits with: 128 + the first signal's number, 130 for Ctrl-C.
int interrupt_exit_code();

}  // namespace bounce
