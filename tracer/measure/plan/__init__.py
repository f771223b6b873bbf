"""`raytree plan --measure`: the cost of each capability, by rendering with and without it."""
