/* Status of a contact pair, the same in all rooms; without PETSc */
#pragma once

typedef enum { CONTACT_OPEN, CONTACT_STICK, CONTACT_SLIP, CONTACT_N_STATUS } ContactStatus;
