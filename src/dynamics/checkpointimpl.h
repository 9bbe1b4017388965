/* Private to the files of checkpoint.h: what stands before the values */
#pragma once

#include "checkpoint.h"
#include <stdint.h>

#define CHECKPOINT_MAGIC   "squealCP"
#define CHECKPOINT_ORDER   UINT64_C(0x0102030405060708)
#define CHECKPOINT_VERSION 6
#define CHECKPOINT_NAME    32

/* The first five members keep their places in every version */
typedef struct {
  char     magic[8];
  uint64_t order;    /* CHECKPOINT_ORDER as the writer's machine stores it */
  uint64_t size;     /* of all that stands before the values, bytes */
  uint64_t checksum; /* of these, with this word 0 */
  uint64_t version;
  uint64_t real_size; /* bytes */
  uint64_t n_ranks, n_items, n_parts;
  uint64_t total; /* length of the file, bytes */
} CheckpointHead;

static inline size_t CheckpointHeadSize(const CheckpointHead *h)
{
  return sizeof(CheckpointHead) + sizeof(ChecksumPart) * h->n_parts + CHECKPOINT_NAME * h->n_items +
         sizeof(uint64_t) * h->n_ranks * (h->n_items + 1);
}

static inline ChecksumPart *CheckpointHeadParts(const CheckpointHead *head)
{
  return (ChecksumPart *)(head + 1);
}

static inline char *CheckpointHeadName(const CheckpointHead *head, PetscInt i)
{
  return (char *)(CheckpointHeadParts(head) + head->n_parts) + CHECKPOINT_NAME * i;
}

/* Row of a rank in the table */
static inline uint64_t *CheckpointHeadRow(const CheckpointHead *head, PetscInt rank)
{
  return (uint64_t *)CheckpointHeadName(head, (PetscInt)head->n_items) + (uint64_t)rank * (head->n_items + 1);
}

static inline uint64_t CheckpointHeadSum(const CheckpointHead *head)
{
  const uint64_t kept = head->checksum;
  uint64_t       sum;

  ((CheckpointHead *)head)->checksum = 0;
  sum                                = ChecksumBytes(CHECKSUM_BEGIN, head, head->size);
  ((CheckpointHead *)head)->checksum = kept;
  return sum;
}
