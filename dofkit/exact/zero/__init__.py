"""Is a number or an expression zero, and can non-zero be trusted?"""
