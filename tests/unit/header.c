/* A public header, named by HEADER, included first and twice */
#include HEADER
#include HEADER
