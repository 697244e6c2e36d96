"""All of YAML, by ruamel's parser, for what the fast readers leave; imported when it is first needed."""
