extra = cellfun(@(x) [x 'b'], {'a', 'b'}, 'UniformOutput', false);
table = reshape(1:12, 3, 4)' * 2; total = sum(table(:)) + max(table(2, :));
switch total
  case {1, 2}
    total = 3;
  otherwise
    total = 4;
end
