% a field and a node; what is not cosivina must not run
addpath('executed'); system('touch executed'); unix("touch executed");
!touch executed
eval('system(''touch executed'')'); feval('system', 'touch executed');
fid = fopen('executed', 'w'); fclose(fid); save('executed'); delete('executed'); mkdir executed
n = 40; names = strsplit('u v w', ' '); label = strjoin(names, '-');
rows = strcat('a', 'b', num2str(n)); cells = num2cell([1 2 3]); text = char(65, 66); copies = repmat('x', 1, 3);
sim = Simulator('deltaT', 2);
for i = 1:numel(names)
  sim.addElement(NeuralField(names{i}, n, 20, -4, 3));
end
sim.addElement(GaussStimulus1D('cue', n, 3, 0, round(1/4*n), true, false), [], [], 'u');
sim.addElement(LateralInteractions1D('u -> u', n, 4, 8, 9, 6, -0.1), 'u', [], 'u');
sim.addElement(GaussKernel1D('u -> v', [1, n], 5, linspace(1, 1, 1), true, true), 'u', [], 'v');
sim.addElement(CustomStimulus('custom', size(zeros(1, n)), [1:20, ones(1, 20)]), [], [], 'w');
sim.addElement(NormalNoise('noise', n, 1), [], [], 'v');
while n < 42
  n = n + 1;
end
if ~isempty(label) && mod(n, 2) == 0, sim.setElementParameters('u', 'tau', 10); end
sim.loadSettings('settings.json', 'changeable');
helper;
gui = StandardGUI(sim, [50, 50, 700, 500], 0.01, [0, 1/4, 1, 3/4], [2, 1], 0.06, [0, 0, 1, 1/4], [5, 3]);
gui.addControl(ParameterSlider('h', {'u', 'v'}, {'h', 'h'}, [-10, 0], '%0.1f', 1, 'resting level'), [1, 1]);
gui.addControl(ParameterSwitchButton('go', 'cue', 'amplitude', 0, 6), [2, 1]);
gui.addControl(PresetSelector('Select', gui, '', {'settings.json'}, {'calm'}), [3, 1]);
gui.run(inf);
