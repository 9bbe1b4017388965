"""Tables, pictures, errors and costs of sweeps."""
