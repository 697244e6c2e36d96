"""The dimension at a measured reference configuration: rank with a tolerance, second order, continuation."""
