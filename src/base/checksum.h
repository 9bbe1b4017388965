/*
   Checksum of bytes, 64 bits: for each word w of eight bytes (the last one filled up with zeros)

      h <- (h ^ w) p,   h <- h ^ (h >> 32)

   and at the end one more with the number of bytes. Both maps are one to one in h and in w for odd p, so that a change
   within any single word is always seen; the shift carries the high bits, such as signs, back into the low ones.
   After the FNV-1a hash (Fowler, Noll, Vo; IETF draft-eastlake-fnv), whose offset basis it begins with.
*/
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define CHECKSUM_BEGIN UINT64_C(0xcbf29ce484222325)

static inline uint64_t ChecksumWord(uint64_t h, uint64_t w)
{
  h = (h ^ w) * UINT64_C(0x9e3779b97f4a7c15); /* odd, bits evenly spread: 2^64 divided by the golden ratio */
  return h ^ (h >> 32);
}

/* Goes on from h, CHECKSUM_BEGIN at first, with `size` bytes */
static inline uint64_t ChecksumAdd(uint64_t h, const void *bytes, size_t size)
{
  const char *at   = bytes;
  uint64_t    word = 0;
  size_t      left = size;

  for (; left >= sizeof(word); left -= sizeof(word), at += sizeof(word)) {
    memcpy(&word, at, sizeof(word));
    h = ChecksumWord(h, word);
  }
  word = 0;
  if (left) memcpy(&word, at, left);
  if (left) h = ChecksumWord(h, word);
  return ChecksumWord(h, (uint64_t)size);
}
