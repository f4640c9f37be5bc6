// Ctrl-C as a flag.
#pragma once

namespace bounce {

/// From now on the first Ctrl-C raises a flag; a second one ends the program as usual.
void catch_interrupts();
/// True once Ctrl-C has been pressed.
bool interrupted();

}  // namespace bounce
