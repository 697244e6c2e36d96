"""What students are told, in English, German, French and Spanish."""
