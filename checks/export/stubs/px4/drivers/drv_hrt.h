#include "px4_stub.h"
