/* STUB of a header of cFE: see cfe.h. */
#include "cfe.h"
