"""The live pieces of lessons: pictures with numbers that follow the picked hit, and whose handles can be dragged."""
