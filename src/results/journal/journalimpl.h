/* Private to journal/: what stands before the values */
#pragma once

#include "journal.h"
#include <stdint.h>

#define JOURNAL_MAGIC   "squealCP"
#define JOURNAL_ORDER   UINT64_C(0x0102030405060708)
#define JOURNAL_VERSION 7
#define JOURNAL_NAME    32

/* The first five members keep their places in every version */
typedef struct {
  char     magic[8];
  uint64_t order;    /* JOURNAL_ORDER as the writer's machine stores it */
  uint64_t size;     /* of all that stands before the values, bytes */
  uint64_t checksum; /* of these, with this word 0 */
  uint64_t version;
  uint64_t real_size; /* bytes */
  uint64_t n_ranks, n_items, n_parts;
  uint64_t total; /* length of the file, bytes */
} JournalHead;

static inline size_t JournalHeadSize(const JournalHead *h)
{
  return sizeof(JournalHead) + sizeof(ChecksumPart) * h->n_parts + JOURNAL_NAME * h->n_items +
         sizeof(uint64_t) * h->n_ranks * (h->n_items + 1);
}

static inline ChecksumPart *JournalHeadParts(const JournalHead *head)
{
  return (ChecksumPart *)(head + 1);
}

static inline char *JournalHeadName(const JournalHead *head, PetscInt i)
{
  return (char *)(JournalHeadParts(head) + head->n_parts) + JOURNAL_NAME * i;
}

/* Row of a rank in the table */
static inline uint64_t *JournalHeadRow(const JournalHead *head, PetscInt rank)
{
  return (uint64_t *)JournalHeadName(head, (PetscInt)head->n_items) + (uint64_t)rank * (head->n_items + 1);
}

static inline uint64_t JournalHeadSum(const JournalHead *head)
{
  const uint64_t kept = head->checksum;
  uint64_t       sum;

  ((JournalHead *)head)->checksum = 0;
  sum                             = ChecksumBytes(CHECKSUM_BEGIN, head, head->size);
  ((JournalHead *)head)->checksum = kept;
  return sum;
}
